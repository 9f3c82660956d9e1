#include "moclean/filter/savitzky_golay.hpp"

#include <algorithm>
#include <vector>

#include <Eigen/QR>
#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/filter/observed.hpp"

namespace moclean {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// H, [window x window]: H y is the least-squares polynomial of y at the window's frames. With the
// orthonormal basis Q of the polynomials H = QQ'; frames are scaled to [-1, 1].
MatrixXd projection(Index window, Index order) {
  VectorXd t = VectorXd::Zero(window);
  if (window > 1) t = VectorXd::LinSpaced(window, -1, 1);
  MatrixXd powers(window, order + 1);
  powers.col(0).setOnes();
  for (Index k = 1; k <= order; ++k) powers.col(k) = powers.col(k - 1).cwiseProduct(t);
  const Eigen::HouseholderQR<MatrixXd> qr(powers);
  const MatrixXd q = qr.householderQ() * MatrixXd::Identity(window, order + 1);
  return q * q.transpose();
}

void smooth_run(const MatrixXd& h, Index order, std::span<double> run) {
  const Index n = static_cast<Index>(run.size()), window = h.rows(), half = window / 2;
  Eigen::Map<VectorXd> z(run.data(), n);
  const VectorXd y = z;
  if (n < window) {
    z = projection(n, std::min(order, n - 1)) * y;
    return;
  }
  z.head(half + 1) = h.topRows(half + 1) * y.head(window);
  const Eigen::RowVectorXd middle = h.row(half);
  for (Index i = half + 1; i + half < n; ++i) z(i) = middle.dot(y.segment(i - half, window));
  z.tail(half) = h.bottomRows(half) * y.tail(window);
}

}  // namespace

void check(const SavitzkyGolay& filter) {
  if (filter.window < 1 || filter.window % 2 == 0 || filter.window > 999)
    throw ArgumentError(fmt::format(
        "savitzky-golay: window is {}, expected an odd number of frames up to 999", filter.window));
  if (filter.order < 0 || filter.order >= filter.window || filter.order > 12)
    throw ArgumentError(fmt::format(
        "savitzky-golay: order is {}, expected 0 to 12 and less than the window of {} frames",
        filter.order, filter.window));
}

void smooth(const SavitzkyGolay& filter, double, std::span<double> channel) {
  const MatrixXd h = projection(filter.window, filter.order);
  for_each_run(channel, [&](std::span<double> run) { smooth_run(h, filter.order, run); });
}

}  // namespace moclean
