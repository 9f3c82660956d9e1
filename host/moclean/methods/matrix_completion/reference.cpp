// Notation: D data, P its observed entries, X the completed matrix, Y what is thresholded, tau the
// threshold, delta the step; see methods/matrix_completion/matrix_completion.hpp.
#include "moclean/methods/matrix_completion/reference.hpp"

#include <utility>

#include "moclean/core/error.hpp"
#include "moclean/solve/reference_svd.hpp"

namespace moclean::reference {

CompletionSolution solve(const ConstMatrixRef& data, const MatrixCompletion& method,
                         const std::stop_token& stop) {
  const CompletionStart start = start_completion(data, method);
  const Matrix zero = Matrix::Zero(data.rows(), data.cols());
  CompletionSolution solution{zero, zero, {}};
  SegmentOutcome& outcome = solution.outcome;
  outcome.converged = start.norm == 0;
  if (outcome.converged) return solution;

  double delta = start.delta, before = 1;
  Eigen::MatrixXd Y = start.kick(thin_svd(start.data).sigma(0)) * start.data;
  while (!outcome.converged && outcome.iterations < method.max_iterations) {
    if (stop.stop_requested()) throw Cancelled();
    const Svd svd = thin_svd(Y);  // X = U max(sigma - tau, 0) V'
    const Index r = (svd.sigma.array() > start.tau).count();
    const Eigen::VectorXd kept = svd.sigma.head(r).array() - start.tau;
    solution.low_rank = svd.u.leftCols(r) * kept.asDiagonal() * svd.v.leftCols(r).transpose();
    solution.sparse = start.observed.cwiseProduct(start.data - solution.low_rank);  // P(D - X)
    Y += delta * solution.sparse;
    ++outcome.iterations;
    outcome.rank = static_cast<int>(r);
    outcome.residual = solution.sparse.norm() / start.norm;
    outcome.converged = outcome.residual <= method.tolerance;
    delta = next_step(delta, outcome.residual, std::exchange(before, outcome.residual));
  }
  return solution;
}

}  // namespace moclean::reference
