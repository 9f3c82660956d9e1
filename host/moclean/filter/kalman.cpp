// Notation: x state, P its covariance, F transition, Q = process^2 gg' covariance of a push,
// R = measurement^2; a hat marks what the frames so far say, the smoothed state is what all say.
#include "moclean/filter/kalman.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/filter/observed.hpp"

namespace moclean {
namespace {

template <int order>
struct Step {
  Eigen::Matrix<double, order, 1> x_predicted, x;
  Eigen::Matrix<double, order, order> P_predicted, P;
};

template <int order>
class Smoother {
 public:
  using State = Eigen::Matrix<double, order, 1>;
  using Covariance = Eigen::Matrix<double, order, order>;

  // Time is counted in frames, so that the entries of P are of like size.
  Smoother(double process_per_frame, double measurement) : R_(measurement * measurement) {
    F_.setIdentity();
    State g;
    for (int i = 0; i + 1 < order; ++i) F_(i, i + 1) = 1;
    if constexpr (order == 3) {
      F_(0, 2) = 0.5;
      g << 0.5, 1, 1;
    } else {
      g << 0.5, 1;
    }
    Q_ = process_per_frame * process_per_frame * g * g.transpose();
  }

  // `range` is that of the samples.
  void operator()(std::span<double> channel, double range) const {
    std::vector<Step<order>> steps(channel.size());
    filter(channel, range, steps);
    State x = steps.back().x;
    write(x, channel.back());
    for (std::size_t t = steps.size() - 1; t-- > 0;) {
      const Step<order>& now = steps[t];
      const Step<order>& next = steps[t + 1];
      // x = x^ + C (x+ - Fx^), C = P^ F' (P+ predicted)^-1
      const State correction = next.P_predicted.ldlt().solve(x - next.x_predicted);
      x = now.x + now.P * F_.transpose() * correction;
      write(x, channel[t]);
    }
  }

 private:
  void filter(std::span<const double> channel, double range,
              std::vector<Step<order>>& steps) const {
    range = std::max(range, std::sqrt(R_));
    State x = State::Zero();
    x(0) = channel.front();
    Covariance P = Covariance::Identity() * range * range;
    P(0, 0) = R_;
    steps.front() = {x, x, P, P};
    for (std::size_t t = 1; t < steps.size(); ++t) {
      Step<order>& step = steps[t];
      step.x_predicted = F_ * x;
      step.P_predicted = F_ * P * F_.transpose() + Q_;
      x = step.x_predicted;
      P = step.P_predicted;
      if (!std::isnan(channel[t])) {
        const State gain = P.col(0) / (P(0, 0) + R_);
        x += gain * (channel[t] - x(0));
        // Joseph's form keeps P symmetric and positive.
        Covariance rest = Covariance::Identity();
        rest.col(0) -= gain;
        P = (rest * P * rest.transpose() + R_ * gain * gain.transpose()).eval();
      }
      step.x = x;
      step.P = P;
    }
  }

  static void write(const State& x, double& sample) {
    if (!std::isnan(sample)) sample = x(0);
  }

  Covariance F_, Q_;
  double R_;
};

void require_sensible(const char* name, const std::optional<double>& value) {
  constexpr double least = 1e-100, most = 1e100;
  if (value && !(*value >= least && *value <= most))
    throw ArgumentError(fmt::format("kalman: {} is {}, expected a number from {} to {}", name,
                                    *value, least, most));
}

double range_of(std::span<const double> channel) {
  double least = channel.front(), most = least;
  for (const double y : channel) {
    if (std::isnan(y)) continue;
    least = std::min(least, y);
    most = std::max(most, y);
  }
  return most - least;
}

struct Deviations {
  double process, measurement;
};

// See the struct.
Deviations deviations_of(const KalmanSmoother& filter, double range) {
  constexpr double ratio = 1000, share = 1e-3;
  if (!filter.process && !filter.measurement) return {ratio * share * range, share * range};
  return {filter.process.value_or(ratio), filter.measurement.value_or(1)};
}

}  // namespace

void check(const KalmanSmoother& filter) {
  require_sensible("process", filter.process);
  require_sensible("measurement", filter.measurement);
}

void smooth(const KalmanSmoother& filter, double frame_rate, std::span<double> channel) {
  channel = between_ends(channel);
  if (channel.size() < 2) return;
  const double range = range_of(channel);
  if (range == 0) return;  // a constant
  const auto [process, measurement] = deviations_of(filter, range);
  const double per_frame = process / (frame_rate * frame_rate);  // lengths per frame squared
  const int exponent = std::ilogb(range);
  const auto scaled = [&](double value) { return std::ldexp(value, -exponent); };
  scale_by_power(channel, -exponent);
  if (filter.model == KalmanSmoother::Model::velocity)
    Smoother<2>(scaled(per_frame), scaled(measurement))(channel, scaled(range));
  else
    Smoother<3>(scaled(per_frame), scaled(measurement))(channel, scaled(range));
  scale_by_power(channel, exponent);
}

}  // namespace moclean
