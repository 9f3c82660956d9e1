#include "moclean/methods/matrix_completion/matrix_completion.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/solve/missing.hpp"

namespace moclean {
namespace {

void require_positive(const char* name, double value, double most) {
  if (!(value > 0 && value <= most))
    throw ArgumentError(
        fmt::format("{} is {}, expected a positive number up to {}", name, value, most));
}

}  // namespace

void check(const MatrixCompletion& method) {
  constexpr double most = 1e6;  // beyond, entries are lost in the rounding of Y
  require_positive("threshold", method.threshold, most);
  require_positive("step", method.step, most);
  require_positive("tolerance", method.tolerance, most);
  if (method.max_iterations < 1)
    throw ArgumentError(
        fmt::format("max-iterations is {}, expected at least 1", method.max_iterations));
}

double CompletionStart::kick(double norm_2) const {
  return std::ceil(tau / (delta * norm_2)) * delta;
}

double next_step(double delta, double after, double before) {
  constexpr double sure = 1.9, rounding = 1e-9;
  return after > (1 + rounding) * before ? std::min(delta, sure) : delta;
}

CompletionStart start_completion(const ConstMatrixRef& data, const MatrixCompletion& method) {
  CompletionStart start;
  start.observed = observed_entries(data);
  start.data = observed_part(data);
  start.norm = start.data.norm();
  start.tau = method.threshold * start.norm;
  start.delta = method.step * static_cast<double>(data.size()) / start.observed.sum();
  return start;
}

}  // namespace moclean
