#include "moclean/solve/reference_svd.hpp"

#include <limits>

#include <Eigen/QR>
#include <Eigen/SVD>

namespace moclean::reference {
namespace {

constexpr unsigned both_sides = Eigen::ComputeThinU | Eigen::ComputeThinV;

// False also when anything is NaN: every comparison with NaN is.
bool multiplies_to(const Svd& svd, const Eigen::MatrixXd& x) {
  const double bound = 100 * std::numeric_limits<double>::epsilon() * static_cast<double>(x.cols());
  const Eigen::MatrixXd product = svd.u * svd.sigma.asDiagonal() * svd.v.transpose();
  return (product - x).norm() <= bound * x.norm();
}

Svd square_svd(const Eigen::MatrixXd& x) {
  const Eigen::BDCSVD<Eigen::MatrixXd> quick(x, both_sides);
  if (quick.info() == Eigen::Success) {
    Svd svd{quick.matrixU(), quick.singularValues(), quick.matrixV()};
    if (multiplies_to(svd, x)) return svd;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> careful(x, both_sides);
  return {careful.matrixU(), careful.singularValues(), careful.matrixV()};
}

}  // namespace

Svd thin_svd(const Eigen::MatrixXd& x) {
  if (x.rows() < x.cols()) {
    Svd transposed = thin_svd(x.transpose());
    return {std::move(transposed.v), std::move(transposed.sigma), std::move(transposed.u)};
  }
  if (x.rows() == x.cols()) return square_svd(x);

  // X = Q R, R = U_R diag(sigma) V', hence U = Q U_R.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(x);
  Svd svd = square_svd(qr.matrixQR().topRows(x.cols()).triangularView<Eigen::Upper>());
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(x.rows(), x.cols());
  u.topRows(x.cols()) = svd.u;
  u.applyOnTheLeft(qr.householderQ());
  svd.u = std::move(u);
  return svd;
}

}  // namespace moclean::reference
