#include "moclean/filter/butterworth.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/filter/observed.hpp"

namespace moclean {
namespace {

// y_t = b0 x_t + b1 x_{t-1} + b2 x_{t-2} - a1 y_{t-1} - a2 y_{t-2}, gain 1 at frequency 0.
struct Section {
  double b0, b1, b2, a1, a2;
};

// The analogue poles exp(i pi (2k + order + 1) / (2 order)), scaled to the cut-off and mapped by
// z = (1 + p) / (1 - p); a pair of conjugate ones makes a section, its zeros are at -1.
std::vector<Section> design(const Butterworth& filter, double frame_rate) {
  const double warped = std::tan(std::numbers::pi * filter.cutoff / frame_rate);
  const auto order = static_cast<double>(filter.order);
  std::vector<Section> sections;
  for (Index k = 0; k < filter.order / 2; ++k) {
    const double angle = std::numbers::pi * (2 * static_cast<double>(k) + order + 1) / (2 * order);
    const std::complex<double> p = warped * std::polar(1.0, angle);
    const std::complex<double> z = (1.0 + p) / (1.0 - p);
    const double a1 = -2 * z.real(), a2 = std::norm(z);
    const double gain = (1 + a1 + a2) / 4;
    sections.push_back({gain, 2 * gain, gain, a1, a2});
  }
  if (filter.order % 2 != 0) {
    const double a1 = -(1 - warped) / (1 + warped);
    const double gain = (1 + a1) / 2;
    sections.push_back({gain, gain, 0, a1, 0});
  }
  return sections;
}

// One pass in transposed direct form II, from the steady state of the first sample.
void pass(const Section& s, std::vector<double>& x) {
  double z2 = (s.b2 - s.a2) * x.front();
  double z1 = (s.b1 - s.a1) * x.front() + z2;
  for (double& value : x) {
    const double input = value;
    value = s.b0 * input + z1;
    z1 = s.b1 * input - s.a1 * value + z2;
    z2 = s.b2 * input - s.a2 * value;
  }
}

void filter_run(const std::vector<Section>& sections, std::size_t padding, std::span<double> run) {
  const std::size_t n = run.size(), pad = std::min(padding, n - 1);
  std::vector<double> x(n + 2 * pad);
  std::ranges::copy(run, x.begin() + static_cast<std::ptrdiff_t>(pad));
  for (std::size_t i = 1; i <= pad; ++i) {
    x[pad - i] = 2 * run.front() - run[i];
    x[pad + n - 1 + i] = 2 * run.back() - run[n - 1 - i];
  }
  for (int direction = 0; direction < 2; ++direction) {
    for (const Section& section : sections) pass(section, x);
    std::ranges::reverse(x);
  }
  std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(pad), n, run.begin());
}

}  // namespace

void check(const Butterworth& filter) {
  if (!(filter.cutoff > 0 && std::isfinite(filter.cutoff)))
    throw ArgumentError(
        fmt::format("butterworth: cutoff is {}, expected a positive frequency", filter.cutoff));
  if (filter.order < 1 || filter.order > 12)
    throw ArgumentError(fmt::format("butterworth: order is {}, expected 1 to 12", filter.order));
}

void smooth(const Butterworth& filter, double frame_rate, std::span<double> channel) {
  if (!(filter.cutoff < frame_rate / 2))
    throw ArgumentError(
        fmt::format("butterworth: cutoff is {} Hz, expected less than half the frame rate of {} Hz",
                    filter.cutoff, frame_rate));
  constexpr double least_share = 1e-5;
  if (filter.cutoff < least_share * frame_rate)
    throw ArgumentError(
        fmt::format("butterworth: cutoff is {} Hz, expected at least {} of the frame rate of {} Hz",
                    filter.cutoff, least_share, frame_rate));
  const std::vector<Section> sections = design(filter, frame_rate);
  const auto padding = static_cast<std::size_t>(3 * (filter.order + 1));
  for_each_run(channel, [&](std::span<double> run) { filter_run(sections, padding, run); });
}

}  // namespace moclean
