#pragma once

#include <array>
#include <string_view>

#include "moclean/core/parameters.hpp"

namespace moclean {

/// Singular value thresholding of the noisy matrix in one step: A = U f(sigma) V' with
/// f(sigma) = max(sigma - tau, 0), or sigma above tau and 0 below ("hard"); E = D - A.
///
/// Without a threshold tau follows from the median singular value, taken for one of white noise of
/// unknown size in every entry. With m the longer and n the shorter side, beta = n/m, and mu the
/// median of the Marchenko-Pastur law of that ratio:
///   hard  tau = median(sigma) sqrt(2 (beta + 1) + 8 beta / (beta + 1 + sqrt(beta^2 + 14 beta +
///   1)))
///               / sqrt(mu)   (Gavish, Donoho 2014, equations 11 and 14)
///   soft  tau = median(sigma) (1 + sqrt(beta)) / sqrt(mu), the edge of the noise's singular values
/// A median of zero, as in a matrix of low rank without noise, leaves the matrix as it is.
/// With fewer than three rows or columns the median is no noise, and a threshold has to be given.
struct SingularValueThresholding {
  enum class Shrink { soft, hard };

  double threshold = 0;  ///< tau >= 0 in the unit of the clip; 0: by the rule
  Shrink shrink = Shrink::soft;

  bool operator==(const SingularValueThresholding&) const = default;

  static constexpr std::string_view name = "svt";
  static constexpr std::array<std::string_view, 2> shrinks = {"soft", "hard"};
  static void visit(auto& self, auto& visitor) {
    visitor("threshold", self.threshold);
    visitor("shrink", self.shrink, shrinks);
  }
};

/// Throws ArgumentError naming the first parameter out of its range.
void check(const SingularValueThresholding& method);

/// Median of the Marchenko-Pastur law of ratio beta, 0 < beta <= 1, and noise of variance 1: half
/// of its mass on [(1 - sqrt(beta))^2, (1 + sqrt(beta))^2] is below. By Simpson's rule, to 1e-6.
double marchenko_pastur_median(double beta);

/// tau / median(sigma) of the rules above.
double threshold_factor(SingularValueThresholding::Shrink shrink, double beta);

}  // namespace moclean
