#include "moclean/methods/matrix_completion/matrix_completion.hpp"

#include <cmath>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/solve/missing.hpp"

namespace moclean {
namespace {

void require_positive(const char* name, double value) {
  if (!(value > 0 && std::isfinite(value)))
    throw ArgumentError(fmt::format("{} is {}, expected a positive number", name, value));
}

}  // namespace

void check(const MatrixCompletion& method) {
  require_positive("threshold", method.threshold);
  require_positive("step", method.step);
  require_positive("tolerance", method.tolerance);
  if (method.max_iterations < 1)
    throw ArgumentError(
        fmt::format("max-iterations is {}, expected at least 1", method.max_iterations));
}

double CompletionStart::kick(double norm_2) const {
  return std::ceil(tau / (delta * norm_2)) * delta;
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
