#include "moclean/denoise/body_findings.hpp"

#include <algorithm>
#include <limits>

#include "moclean/body/fill_gaps.hpp"
#include "moclean/body/jump_flags.hpp"
#include "moclean/body/length_noise.hpp"
#include "moclean/body/rigid_flags.hpp"
#include "moclean/body/splices.hpp"
#include "moclean/methods/matrix_normal/rounding_step.hpp"
#include "moclean/methods/matrix_normal/statistics.hpp"

namespace moclean {
namespace {

constexpr double edge_floor = 1e-4;       // least spread of a distance, share of the body's size
constexpr double filled_seconds = 0.067;  // shortest gap that the body fills
constexpr double soft_floor = 2e-3;       // deviation of distances that is steady, share of size

// The body of a take whose differences in time show noise of the deviation `dense`; what its
// lengths show beyond goes to the prior. Raises `smallest` to their noise.
RigidBody learn_body(const BodyTake& take, double dense, double rounding, BodyFindings& found) {
  found.smallest = std::max(found.smallest, noise_of_distance * dense);
  RigidBody body = learn_rigid_body(take, found.smallest, rounding);
  if (std::ranges::any_of(body.edges, &RigidEdge::exact)) return body;
  const LengthNoise noise = length_noise(take);
  if (!noise.correlated(found.prior.size, dense)) return body;
  found.prior.noise = noise.slow;
  found.smallest = std::max(found.smallest, noise_of_distance * noise.deviation);
  return learn_rigid_body(take, found.smallest, rounding);
}

// Limbs that jump away and back are bad; a jump that stays begins another motion.
void look_for_jumps(const BodyTake& take, const RigidBody& body, const Mask& consistent,
                    BodyFindings& found) {
  const Mask trusted = consistent && !found.bad && take.seen;
  std::vector<SuddenSteps> steps =
      sudden_steps(take, trusted, least_sudden_step(found.prior.size, found.smallest));
  Mask jumps = jump_flags(take, steps, body);
  found.other_motions = splices(trusted, steps, body, jumps);
  if (!found.other_motions.empty()) {
    for (const Index frame : found.other_motions) forget_steps_into(frame, steps);
    jumps = jump_flags(take, steps, body);
  }
  found.bad = found.bad || jumps;
}

}  // namespace

BodyFindings look_at(const BodyTake& take, const Matrix& samples) {
  BodyFindings found;
  MotionPrior& known = found.prior;
  known.size = body_size(take);
  if (known.size <= 0) return found;
  found.smallest = edge_floor * known.size;
  const double rounding = rounding_deviation(samples);
  const double dense = std::max(dense_noise_level(samples), rounding);
  const RigidBody body = learn_body(take, dense, rounding, found);
  for (const RigidEdge& edge : body.edges)
    if (edge.hard || edge.exact)
      known.links.push_back({edge.first, edge.second, edge.length, edge.hard, edge.exact});
  RigidFlags flags = vote_on_joints(take, body, known.size, found.smallest, known.noise <= 0);
  found.bad = std::move(flags.bad);
  known.confirmed = std::move(flags.confirmed);
  found.bones = std::move(flags.bones);
  if (body.is_rigid()) look_for_jumps(take, body, flags.consistent, found);
  return found;
}

void fill_from_body(const BodyTake& take, BodyFindings& found) {
  MotionPrior& known = found.prior;
  known.confirmed = known.confirmed && !found.bad;
  known.positions = Matrix::Zero(take.frames(), 3 * take.joints());
  known.variance =
      Matrix::Constant(take.frames(), take.joints(), std::numeric_limits<double>::infinity());
  const double floor = std::max(found.smallest, soft_floor * known.size);
  const Index least = odd_frames(filled_seconds, take.frame_rate);
  Index first = 0;
  std::vector<Index> ends = found.other_motions;
  ends.push_back(take.frames());
  for (const Index last : ends) {
    const Index frames = last - first;
    const Fills fills =
        fill_gaps({take.positions.middleRows(first, frames),
                   take.seen.middleRows(first, frames) && !found.bad.middleRows(first, frames),
                   take.frame_rate},
                  floor, least);
    if (!fills.empty()) {
      known.positions.middleRows(first, frames) = fills.positions;
      known.variance.middleRows(first, frames) = fills.variance;
    }
    first = last;
  }
}

}  // namespace moclean
