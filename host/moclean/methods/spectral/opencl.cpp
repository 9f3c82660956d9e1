// Notation: D data, G a Gram matrix, Z its eigenvectors in rows, B = DZ' (ZD for wide segments)
// with eigenvectors P, f the weights of the singular values, W = Z' diag(f) Z and A = DW (WD).
#include "moclean/methods/spectral/opencl.hpp"

#include <algorithm>
#include <cmath>

#include "moclean/core/error.hpp"
#include "moclean/linalg/memory_layout.hpp"
#include "moclean/methods/spectral/weights.hpp"
#include "moclean/solve/opencl/stacked_rows.hpp"

namespace moclean::opencl {
namespace {

struct Memory {
  explicit Memory(MemoryLayout& of)
      : D(of.stacked()),
        A(of.stacked(Initially::zero)),
        B(of.stacked(Initially::zero)),
        G(of.square(Initially::zero)),
        Z(of.square(Initially::zero)),
        P(of.square(Initially::zero)),
        W(of.square(Initially::zero)),
        eigenvalues(of.vector(Initially::zero)),
        f(of.vector()),
        terms(of.per_segment<std::int32_t>()) {}

  Buffer<double> D, A, B, G, Z, P, W, eigenvalues, f;
  Buffer<std::int32_t> terms;
};

// Singular values of a segment, decreasing.
std::vector<double> singular_values(const SegmentRecord& segment, std::span<const double> all) {
  std::vector<double> sigma;
  for (int k = 0; k < segment.order; ++k)
    sigma.push_back(std::sqrt(std::max(all[static_cast<std::size_t>(segment.vector + k)], 0.0)));
  return sigma;
}

}  // namespace

SpectralSolver::SpectralSolver(const Device& device, const Tuning& tuning)
    : device_(device),
      products_(device, (moclean::check(tuning), tuning)),
      eigen_(device, tuning) {}

std::uint64_t SpectralSolver::bytes_of(Index rows, Index columns) const {
  return moclean::memory_of<Memory>(rows, columns) + eigen_.memory_of(std::min(rows, columns));
}

template <class Chosen>
void SpectralSolver::weigh(const SegmentBatch& data, Index first, Index last, const Chosen& method,
                           Solution& solution, const Finished& finished,
                           const std::stop_token& stop) {
  if (stop.stop_requested()) throw Cancelled();
  Batch batch(device_, data, first, last);
  MemoryLayout layout(device_, batch);
  Memory m(layout);
  m.D.write(stacked_rows(data, first, last));
  products_.gram(batch, m.D, m.G);
  eigen_(batch, m.G, m.Z, m.eigenvalues);
  products_.rotate(batch, m.D, m.Z, m.B);
  products_.gram(batch, m.B, m.G);
  eigen_(batch, m.G, m.P, m.eigenvalues);
  products_.compose(batch, m.P, m.Z, m.G);
  eigen_.check(batch);

  std::vector<double> eigenvalues(m.eigenvalues.size()), f(m.f.size(), 0);
  m.eigenvalues.read(eigenvalues);
  std::vector<std::int32_t> terms;
  for (Index b = 0; b < batch.segments(); ++b) {
    const SegmentRecord& segment = batch.segment(b);
    const std::vector<double> sigma = singular_values(segment, eigenvalues);
    SegmentOutcome& outcome = solution.segments[static_cast<std::size_t>(first + b)];
    outcome.converged = true;
    terms.push_back(1);  // W = 0 where f is
    if (sigma[0] == 0) continue;
    const auto weights = weights_of(method, sigma, segment.rows, segment.columns);
    std::ranges::copy(weights, f.begin() + segment.vector);
    outcome.iterations = 1;
    outcome.rank = static_cast<int>(std::ranges::count_if(weights, [](double w) { return w > 0; }));
    terms.back() = std::max(1, *outcome.rank);
  }
  m.f.write(f);
  m.terms.write(terms);
  products_.reconstruct(batch, m.G, m.f, m.terms, m.W);
  products_.apply(batch, m.D, m.W, m.A);
  m.A.read(stacked_rows(solution.low_rank, first, last));
  for (Index b = first; b < last; ++b)
    solution.sparse.segment(b) = data.segment(b) - solution.low_rank.segment(b);
  finished(last - first);
}

void SpectralSolver::solve(const Problem& problem, Index first, Index last,
                           const TruncatedSvd& method, Solution& solution, const Finished& finished,
                           const std::stop_token& stop) {
  weigh(problem.data, first, last, method, solution, finished, stop);
}

void SpectralSolver::solve(const Problem& problem, Index first, Index last,
                           const SingularValueThresholding& method, Solution& solution,
                           const Finished& finished, const std::stop_token& stop) {
  weigh(problem.data, first, last, method, solution, finished, stop);
}

}  // namespace moclean::opencl
