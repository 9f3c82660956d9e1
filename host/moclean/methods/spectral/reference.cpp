#include "moclean/methods/spectral/reference.hpp"

#include <algorithm>

#include "moclean/core/error.hpp"
#include "moclean/solve/reference_svd.hpp"

namespace moclean::reference {
namespace {

template <class Chosen>
SpectralSolution weigh(const ConstMatrixRef& data, const Chosen& method,
                       const std::stop_token& stop) {
  if (stop.stop_requested()) throw Cancelled();
  const Svd svd = thin_svd(data);
  const std::vector<double> sigma(svd.sigma.begin(), svd.sigma.end());
  if (sigma[0] == 0) {
    const Matrix zero = Matrix::Zero(data.rows(), data.cols());
    return {zero, zero, {.iterations = 0, .rank = 0, .residual = 0, .converged = true}};
  }
  const std::vector<double> f = weights_of(method, sigma, data.rows(), data.cols());
  const auto r = std::ranges::count_if(f, [](double weight) { return weight > 0; });
  Eigen::VectorXd kept(r);
  for (Index k = 0; k < r; ++k) kept(k) = f[static_cast<std::size_t>(k)] * svd.sigma(k);

  SpectralSolution solution;
  solution.low_rank = svd.u.leftCols(r) * kept.asDiagonal() * svd.v.leftCols(r).transpose();
  solution.sparse = data - solution.low_rank;
  solution.outcome = {
      .iterations = 1, .rank = static_cast<int>(r), .residual = 0, .converged = true};
  return solution;
}

}  // namespace

SpectralSolution solve(const ConstMatrixRef& data, const TruncatedSvd& method,
                       const std::stop_token& stop) {
  return weigh(data, method, stop);
}

SpectralSolution solve(const ConstMatrixRef& data, const SingularValueThresholding& method,
                       const std::stop_token& stop) {
  return weigh(data, method, stop);
}

}  // namespace moclean::reference
