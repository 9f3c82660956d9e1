#include "peers/peer_backend.hpp"

#include <atomic>
#include <thread>

#include "moclean/core/error.hpp"

namespace moclean::bench {
namespace {

SegmentOutcome solve_segment(peers::SegmentSolver& solver, const SegmentBatch& data, Index b,
                             const RobustPca& method, Solution& solution) {
  const ConstMatrixView D = data.segment(b);
  const peers::Segment segment{.data = D.data(),
                               .low_rank = solution.low_rank.segment(b).data(),
                               .sparse = solution.sparse.segment(b).data(),
                               .rows = static_cast<int>(D.rows()),
                               .columns = static_cast<int>(D.cols()),
                               .pitch = static_cast<int>(data.pitch())};
  const auto outcome = solver.solve(segment, {.lambda = lambda_of(method, D.rows(), D.cols()),
                                              .rho = method.rho,
                                              .mu0_factor = method.mu0_factor,
                                              .mu_max_factor = method.mu_max_factor,
                                              .tolerance = method.tolerance,
                                              .max_iterations = method.max_iterations});
  return {outcome.iterations, outcome.rank, outcome.residual, outcome.converged};
}

}  // namespace

PeerBackend::PeerBackend(std::string name, int threads, const MakeSolver& make_solver)
    : name_(std::move(name)) {
  for (int t = 0; t < threads; ++t) solvers_.push_back(make_solver());
}

Solution PeerBackend::solve(const Problem& problem, const Method& method, const Monitor&) {
  const auto& robust_pca = std::get<RobustPca>(method);
  const SegmentBatch& data = problem.data;
  check(robust_pca);
  require_finite(data);
  if (robust_pca.order != UpdateOrder::ae)
    throw ArgumentError(name_ + ": order is ea, expected ae");
  Solution solution{SegmentBatch(data.columns(), data.first_rows()),
                    SegmentBatch(data.columns(), data.first_rows()),
                    std::vector<SegmentOutcome>(static_cast<std::size_t>(data.segments()))};

  std::atomic<Index> next = 0;
  const auto work = [&](peers::SegmentSolver& solver) {
    for (Index b = next++; b < data.segments(); b = next++)
      solution.segments[static_cast<std::size_t>(b)] =
          solve_segment(solver, data, b, robust_pca, solution);
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t t = 1; t < solvers_.size(); ++t)
      others.emplace_back([&, t] { work(*solvers_[t]); });
    work(*solvers_[0]);
  }
  return solution;
}

}  // namespace moclean::bench
