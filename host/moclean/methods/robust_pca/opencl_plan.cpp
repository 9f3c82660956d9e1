#include "moclean/methods/robust_pca/opencl_plan.hpp"

#include <algorithm>
#include <cmath>

namespace moclean::opencl {
namespace {

// Squaring X costs half of the digits of its small singular values: sigma is known to about
// 1e-15 |X|_2^2 / sigma. Once 1/mu has fallen below this share of |D|_2 the eigenproblem is solved
// for B instead, whose columns have about the size of the singular values, so that each is known
// to relative accuracy. 1/mu relative to |D|_2 is the same for all segments, so all change over in
// the same iteration, whatever their data and neighbours.
constexpr double graded_below = 6e-7;

double next_tau(double tau, const RobustPca& method) {
  return std::max(tau / method.rho, 1 / (method.mu0_factor * method.mu_max_factor));
}

// Single precision leaves nothing of X that grading could save.
bool is_graded(double tau, const IterationSetting& setting) {
  return !setting.mixed && tau < graded_below;
}

Iteration::Gram gram_of(const Iteration& now, const RobustPca& method,
                        const IterationSetting& setting) {
  if (is_graded(now.tau, setting)) return Iteration::Gram::rotated;
  if (setting.mixed) return Iteration::Gram::single_floats;
  // The first X of order ae is pure (kernels/robust_pca/robust_pca.cl): D'D will do.
  const bool swept = now.number > 0 || method.order == UpdateOrder::ae;
  return setting.fused && swept ? Iteration::Gram::last_sweep : Iteration::Gram::whole_matrix;
}

Iteration iteration(int number, double tau, const RobustPca& method,
                    const IterationSetting& setting) {
  Iteration now{.number = number, .tau = tau};
  now.gram = gram_of(now, method, setting);
  const bool next_is_graded = is_graded(next_tau(tau, method), setting);
  if (next_is_graded) now.vectors = Iteration::Vectors::all;
  if (!setting.fused) return now;
  now.update = setting.mixed || next_is_graded ? Iteration::Update::sweep
                                               : Iteration::Update::sweep_with_gram;
  now.low_rank = setting.columns && !now.graded();
  return now;
}

}  // namespace

Iteration first_iteration(const RobustPca& method, const IterationSetting& setting) {
  return iteration(0, 1 / method.mu0_factor, method, setting);
}

Iteration next_iteration(const Iteration& now, const RobustPca& method,
                         const IterationSetting& setting) {
  return iteration(now.number + 1, next_tau(now.tau, method), method, setting);
}

double steepest_fall(const RobustPca& method) { return 4 * method.rho / 1.5; }

int iterations_until_look(const Iteration& now, double residual, const RobustPca& method) {
  // Products of whole matrices do not leave out what has finished, nor do those of a graded
  // iteration.
  if (now.graded() || !now.swept()) return 1;
  if (now.number == 0) return 1;  // nothing has been read yet, and the first step may be large
  const double steps = std::log(residual / method.tolerance) / std::log(steepest_fall(method));
  return std::clamp(static_cast<int>(steps), 1, method.max_iterations);
}

}  // namespace moclean::opencl
