#include "moclean/methods/robust_pca/opencl_spectrum.hpp"

#include <utility>

#include "moclean/device/kernel_source.hpp"
#include "moclean/methods/robust_pca/opencl_work.hpp"

namespace moclean::opencl {

template <class Real>
RobustPcaSpectrum<Real>::PartialGrams::PartialGrams(const Device& device, const Tuning& tuning)
    : program(device, kernel_source::partial_grams,
              sweep_defines(device, NumberType::float64, tuning)),
      sum(program, "sum_grams"),
      of_floats(program, "gram_of_floats"),
      of_wide_floats(program, "gram_of_wide_floats"),
      narrow(program, "narrow") {}

template <class Real>
RobustPcaSpectrum<Real>::RobustPcaSpectrum(const Device& device, const Tuning& tuning,
                                           const Program& steps)
    : products_(device, tuning),
      eigen_(device, tuning, mixed ? 1e-8 : 1e-12),  // far below what the iteration makes of it
      threshold_(steps, "threshold") {
  const bool fuses = tuning.form == KernelForm::cpu && tuning.products == ProductPath::own;
  if (fuses) partial_grams_.emplace(device, tuning);
}

template <class Real>
IterationSetting RobustPcaSpectrum<Real>::setting(const Memory& m) const {
  return {
      .mixed = mixed, .fused = partial_grams_ && !m.missing, .columns = eigen_.leaves_columns()};
}

// From the eigenproblem of D'D (DD' for wide segments).
template <class Real>
void RobustPcaSpectrum<Real>::of_data(const Batch& batch, Memory& m, const Iteration& first) {
  if constexpr (mixed)
    gram_of_floats(batch, m, m.D, false);
  else
    products_.gram(batch, m.D, m.V);
  eigen_.all_values(batch, m.V, m.eigenvalues);
  if (first.graded()) eigen_.all_vectors(batch, m.V, m.Z);  // it needs a basis
}

template <class Real>
void RobustPcaSpectrum<Real>::of_shifted(const Batch& batch, Memory& m, const Iteration& now) {
  gram(batch, m, now);
  if (!now.graded()) {
    eigen_.values(batch, m.decompose, m.V, m.eigenvalues);
    threshold(batch, m, now);
    if (now.vectors == Iteration::Vectors::all)
      eigen_.all_vectors(batch, m.V, m.Z);
    else
      eigen_.vectors(batch, m.wanted, m.V, m.Z);
    return;
  }
  if constexpr (!mixed) {
    Buffer<double>& P = m.W;  // free until the iteration writes it
    eigen_(batch, m.V, P, m.eigenvalues);
    products_.compose(batch, P, m.Z, m.V);
    std::swap(m.Z, m.V);
    threshold(batch, m, now);
  }
}

template <class Real>
void RobustPcaSpectrum<Real>::gram(const Batch& batch, Memory& m, const Iteration& now) {
  if constexpr (mixed) {
    gram_of_floats(batch, m, m.X, true);
    return;
  } else {
    switch (now.gram) {
      case Iteration::Gram::last_sweep:
        if (batch.has_wide()) products_.gram(batch, m.X, m.V, GramOf::wide);
        return;
      case Iteration::Gram::rotated:
        products_.rotate(batch, m.X, m.Z, m.rotation_target());
        products_.gram(batch, m.rotation_target(), m.V);
        return;
      default:
        products_.gram(batch, m.X, m.V);
    }
  }
}

// Of D, or, `shifted`, of X; `wide` has the rows of wide segments.
template <class Real>
void RobustPcaSpectrum<Real>::gram_of_floats(const Batch& batch, Memory& m,
                                             const Buffer<Real>& wide, bool shifted) {
  if constexpr (mixed) {
    partial_grams_->of_floats.with([&] { return tall_gram_work(batch, sizeof(Real)); })(
        per_block(batch), batch.device_segments(), batch.device_blocks(), batch.active_blocks(),
        m.states, m.decompose, cl_int{shifted}, m.D, m.T, m.A, m.widened, m.V, m.partial_grams);
    sum_partial_grams(batch, m, m.V);
    if (batch.has_wide())
      partial_grams_->of_wide_floats(per_row(batch), batch.device_segments(), batch.device_active(),
                                     wide, m.V);
  }
}

template <class Real>
void RobustPcaSpectrum<Real>::sum_partial_grams(const Batch& batch, Memory& m, Buffer<double>& g) {
  if (batch.partial_size() > 0)
    partial_grams_->sum(per_row(batch), batch.device_segments(), batch.device_active(),
                        m.partial_grams, g);
}

template <class Real>
void RobustPcaSpectrum<Real>::add_up(const Batch& batch, Memory& m) {
  sum_partial_grams(batch, m, m.G);
}

template <class Real>
void RobustPcaSpectrum<Real>::threshold(const Batch& batch, Memory& m, const Iteration& now) {
  threshold_(per_segment(batch), batch.device_segments(), batch.device_active(),
             batch.active_count(), m.eigenvalues, cl_int{now.low_rank}, m.states, m.dual, m.f,
             m.wanted, m.terms);
}

template <class Real>
void RobustPcaSpectrum<Real>::apply(const Batch& batch, Memory& m) {
  if constexpr (!mixed) {
    products_.reconstruct(batch, m.Z, m.f, m.terms, m.W);
    products_.apply(batch, m.X, m.W, m.A);
  }
}

template <class Real>
Multiplier<Real> RobustPcaSpectrum<Real>::multiplier(const Batch& batch, Memory& m,
                                                     const Iteration& now) {
  products_.reconstruct(batch, m.Z, m.f, m.terms, m.W);
  if constexpr (mixed) {
    partial_grams_->narrow(per_row(batch), batch.device_segments(), batch.device_active(), m.states,
                           m.W, m.V, m.Z, m.f, m.W_real, m.V_real, m.Z_real, m.f_real);
    return {m.W_real, m.V_real, m.Z_real, m.f_real, now.low_rank};
  } else {
    return {m.W, m.V, m.Z, m.f, now.low_rank};
  }
}

template class RobustPcaSpectrum<double>;
template class RobustPcaSpectrum<float>;

}  // namespace moclean::opencl
