#include "moclean/methods/robust_pca/opencl_entry_steps.hpp"

#include <algorithm>

#include "moclean/core/error.hpp"
#include "moclean/device/kernel_source.hpp"
#include "moclean/linalg/products.hpp"
#include "moclean/linalg/work_group.hpp"
#include "moclean/methods/robust_pca/opencl_work.hpp"

namespace moclean::opencl {

Defines sweep_defines(const Device& device, NumberType type, const Tuning& tuning) {
  Defines defines = product_defines(device, type, tuning);
  defines["SWEEP_ROWS"] = std::to_string(tuning.sweep_rows);
  return defines;
}

template <class Real>
EntrySteps<Real>::Programs::Programs(const Device& device, std::string_view source,
                                     const Defines& defines)
    : program(device, source, defines),
      start(program, "start"),
      form(program, "form"),
      shrink(program, "shrink"),
      finish(program, "finish") {}

template <class Real>
std::size_t EntrySteps<Real>::Programs::largest_group() const {
  return std::min({start.largest_group(), form.largest_group(), shrink.largest_group(),
                   finish.largest_group()});
}

template <class Real>
EntrySteps<Real>::GroupPrograms::GroupPrograms(const Device& device, int work_group)
    : Programs(device, kernel_source::sweep_group, group_defines(device, work_group)) {}

template <class Real>
EntrySteps<Real>::Sweeps::Sweeps(const Program& program)
    : full(program, "sweep_full"),
      low_rank(program, "sweep_low_rank"),
      wide(program, "sweep_wide") {}

template <class Real>
EntrySteps<Real>::EntrySteps(const Device& device, const Tuning& tuning) {
  if (tuning.form == KernelForm::gpu) {
    if (Memory::mixed) throw ArgumentError("mixed precision works with form cpu only");
    work_group_ = fit_work_group(in_groups_, device, tuning.work_group);
    return;
  }
  in_vectors_.emplace(device, kernel_source::sweep,
                      sweep_defines(device, number_type<Real>, tuning));
  sweeps_.emplace(in_vectors_->program);
}

template <class Real>
Grid EntrySteps<Real>::grid(const Batch& batch) const {
  return in_groups_ ? group_per_block(batch, work_group_) : per_block(batch);
}

template <class Real>
void EntrySteps<Real>::start(const Batch& batch, Memory& m) {
  programs().start(grid(batch), batch.device_segments(), batch.device_blocks(),
                   batch.active_blocks(), m.states, m.D, cl_int{m.missing},
                   m.missing ? m.observed : m.D, m.T, m.A);
}

template <class Real>
void EntrySteps<Real>::form(const Batch& batch, Memory& m, GramOf which) {
  programs().form(grid(batch), batch.device_segments(), batch.device_blocks(),
                  batch.active_blocks(), m.states, cl_int{which == GramOf::wide}, m.D, m.T, m.A,
                  m.E, m.X);
}

template <class Real>
void EntrySteps<Real>::sweep(const Batch& batch, Memory& m, const Multiplier<Real>& by,
                             bool with_gram) {
  const auto launch = [&](Kernel& kernel, LowRankPart of, const auto&... factors) {
    const auto work = [&] {
      return sweep_work(batch, host_copy(m.states), of, with_gram, sizeof(Real));
    };
    kernel.with(work)(grid(batch), batch.device_segments(), batch.device_blocks(),
                      batch.active_blocks(), m.states, m.D, m.T, m.A, m.E, factors...);
  };
  launch(sweeps_->full, LowRankPart::full, by.W, m.scratch, cl_int{with_gram}, m.G, m.partial_grams,
         m.reports);
  if (by.low_rank)
    launch(sweeps_->low_rank, LowRankPart::low_rank, by.V, by.f, by.Z, m.scratch, cl_int{with_gram},
           m.G, m.partial_grams, m.reports);
  if (batch.has_wide()) launch(sweeps_->wide, LowRankPart::wide, by.W, m.X, m.scratch, m.reports);
}

template <class Real>
void EntrySteps<Real>::shrink(const Batch& batch, Memory& m) {
  programs().shrink.with([&] { return shrink_work(batch, host_copy(m.states), sizeof(Real)); })(
      grid(batch), batch.device_segments(), batch.device_blocks(), batch.active_blocks(), m.states,
      m.D, cl_int{m.missing}, m.missing ? m.observed : m.D, m.X, m.A, m.T, m.reports);
}

template <class Real>
void EntrySteps<Real>::finish(const Batch& batch, Memory& m) {
  programs().finish(grid(batch), batch.device_segments(), batch.device_blocks(),
                    batch.active_blocks(), m.states, m.E, m.T);
}

template class EntrySteps<double>;
template class EntrySteps<float>;

}  // namespace moclean::opencl
