#include "moclean/filter/filter.hpp"

#include <algorithm>
#include <atomic>
#include <thread>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

void smooth_column(const Filter& filter, double frame_rate, Matrix& samples, Index column) {
  std::vector<double> channel(static_cast<std::size_t>(samples.rows()));
  Eigen::Map<Eigen::VectorXd> values(channel.data(), samples.rows());
  values = samples.col(column);
  std::visit([&](const auto& f) { smooth(f, frame_rate, channel); }, filter);
  samples.col(column) = values;
}

void require_usable(const Recording& take, const Filter& filter) {
  std::visit([](const auto& f) { check(f); }, filter);
  if (needs_frame_rate(filter) && !(take.frame_rate > 0))
    throw ArgumentError(fmt::format("{} needs the frame rate, which the recording does not state",
                                    name_of(filter)));
  if (const auto* low_pass = std::get_if<Butterworth>(&filter)) {
    double nothing[] = {0};
    smooth(*low_pass, take.frame_rate, nothing);  // throws here, and not on a thread
  }
}

}  // namespace

bool needs_frame_rate(const Filter& filter) {
  return std::visit([]<class F>(const F&) { return has_frame_rate<F>; }, filter);
}

bool fills_gaps(const Filter& filter) {
  return std::visit(
      []<class F>(const F&) {
        return requires { F::fills_gaps; };
      },
      filter);
}

std::string_view name_of(const Filter& filter) {
  return std::visit([]<class F>(const F&) { return F::name; }, filter);
}

std::string to_string(const Filter& filter) {
  return std::visit([](const auto& f) { return to_specification(f); }, filter);
}

Matrix filtered(const Recording& take, const Filter& filter, int jobs) {
  require_usable(take, filter);
  Matrix result = take.samples;
  std::atomic<Index> next = 0;
  const auto work = [&] {
    for (Index c = next++; c < result.cols(); c = next++)
      smooth_column(filter, take.frame_rate, result, c);
  };
  std::vector<std::jthread> others;
  for (Index t = 1; t < std::min<Index>(jobs, result.cols()); ++t) others.emplace_back(work);
  work();
  others.clear();
  return result;
}

}  // namespace moclean
