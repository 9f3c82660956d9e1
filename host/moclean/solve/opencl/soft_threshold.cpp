#include "moclean/solve/opencl/soft_threshold.hpp"

#include <algorithm>
#include <cmath>

namespace moclean::opencl {
namespace {

double sigma(std::span<const double> eigenvalues, const SegmentRecord& segment, int k) {
  return std::sqrt(std::max(eigenvalues[static_cast<std::size_t>(segment.vector + k)], 0.0));
}

}  // namespace

SoftThreshold::Memory::Memory(MemoryLayout& of)
    : G(of.square(Initially::zero)),
      Z(of.square(Initially::zero)),
      W(of.square(Initially::zero)),
      eigenvalues(of.vector(Initially::zero)),
      f(of.vector()),
      terms(of.per_segment<std::int32_t>()),
      host_eigenvalues(eigenvalues.size()),
      host_f(f.size(), 0),
      host_terms(terms.size(), 1) {}

SoftThreshold::SoftThreshold(const Device& device, const Tuning& tuning)
    : products_(device, (moclean::check(tuning), tuning)), eigen_(device, tuning) {}

std::uint64_t SoftThreshold::scratch_of(Index rows, Index columns) const {
  return eigen_.memory_of(std::min(rows, columns));
}

void SoftThreshold::find_values(const Batch& batch, const Buffer<double>& x, Memory& m) {
  products_.gram(batch, x, m.G);
  eigen_.all_values(batch, m.G, m.eigenvalues);
  m.eigenvalues.read(m.host_eigenvalues);
}

std::vector<double> SoftThreshold::spectral_norms(const Batch& batch, const Buffer<double>& x,
                                                  Memory& m) {
  find_values(batch, x, m);
  std::vector<double> norms(static_cast<std::size_t>(batch.segments()), 0);
  for (const std::int32_t b : batch.active())
    norms[static_cast<std::size_t>(b)] = sigma(m.host_eigenvalues, batch.segment(b), 0);
  return norms;
}

void SoftThreshold::operator()(const Batch& batch, const Buffer<double>& x,
                               std::span<const double> taus, Memory& m,
                               std::vector<SegmentOutcome>& outcomes, Buffer<double>& result) {
  find_values(batch, x, m);
  for (const std::int32_t b : batch.active()) {
    const auto i = static_cast<std::size_t>(b);
    const SegmentRecord& segment = batch.segment(b);
    int rank = 0;
    for (int k = 0; k < segment.order; ++k) {
      const double value = sigma(m.host_eigenvalues, segment, k);
      const bool kept = value > taus[i];
      rank += kept;
      m.host_f[static_cast<std::size_t>(segment.vector + k)] = kept ? 1 - taus[i] / value : 0;
    }
    outcomes[i].rank = rank;
    m.host_terms[i] = std::max(1, rank);  // W = 0 where f is
  }
  m.f.write(m.host_f);
  m.terms.write(m.host_terms);
  eigen_.vectors(batch, m.terms, m.G, m.Z);
  products_.reconstruct(batch, m.Z, m.f, m.terms, m.W);
  products_.apply(batch, x, m.W, result);
}

}  // namespace moclean::opencl
