#include "moclean/methods/matrix_normal/matrix_normal.hpp"

#include <cmath>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

void require(bool valid, const char* name, double value, const char* expected) {
  if (!valid || !std::isfinite(value))
    throw ArgumentError(fmt::format("{} is {}, expected {}", name, value, expected));
}

void require_count(const char* name, Index value) {
  require(value >= 1, name, static_cast<double>(value), "at least 1");
}

}  // namespace

void check(const MatrixNormal& method) {
  require_count("joint-columns", method.joint_columns);
  require(method.median_frames >= 1 && method.median_frames % 2 == 1, "median-frames",
          static_cast<double>(method.median_frames), "an odd number of frames");
  require_count("lag-frames", method.lag_frames);
  require_count("soft-steps", method.soft_steps);
  require_count("hard-steps", method.hard_steps);
  require(method.soft_first > 0, "soft-first", method.soft_first, "a positive number");
  require(method.soft_last > 0, "soft-last", method.soft_last, "a positive number");
  require(method.hard > 0, "hard", method.hard, "a positive number");
  require_count("solve-iterations", method.solve_iterations);
  require(method.soft_tolerance >= 0, "soft-tolerance", method.soft_tolerance,
          "a number of at least 0");
  require(method.hard_tolerance >= 0, "hard-tolerance", method.hard_tolerance,
          "a number of at least 0");
}

}  // namespace moclean
