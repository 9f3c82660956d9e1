#pragma once

#include <span>
#include <vector>

#include "moclean/body/body_take.hpp"

namespace moclean {

/// Steps of a joint from each frame to the next, [frames - 1 x 3], unit of the take.
using Velocities = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Which steps of one joint are more sudden than motion is. Both are empty if none can be.
struct SuddenSteps {
  Velocities rest;           ///< what the running median over 0.075 s leaves of the velocity
  std::vector<bool> sudden;  ///< [frames - 1]: see sudden_steps()
};

/// The shortest step that can be sudden: 10 % of the body's size, but six times the deviation of a
/// distance, `smallest`, where noise is dense.
double least_sudden_step(double size, double smallest);

/// The sudden steps of every joint, [joints]: |rest| exceeds 8 times its local scale (the running
/// median over 0.5 s) plus half of the largest speed within 0.06 s plus `least`. Only samples of
/// `trusted` [frames x joints] are looked at, others are interpolated.
std::vector<SuddenSteps> sudden_steps(const BodyTake& take, const Mask& trusted, double least);

/// Calls no step into `frame` sudden any more, nor those next to it in the same run.
void forget_steps_into(Index frame, std::span<SuddenSteps> steps);

}  // namespace moclean
