#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "moclean/backend/backend.hpp"
#include "moclean/motion/recording.hpp"
#include "moclean/segment/plan.hpp"

namespace moclean {

/// Tolerance of robust PCA that is enough to compare segments: 17 iterations instead of 39
/// (docs/decisions/automatic-segments.md).
inline constexpr double coarse_tolerance = 1e-3;

/// Copies of the samples of its takes that cheapest_plans() has at a time: its batches are four
/// times the takes, data and two results; there are medians, too.
inline constexpr std::uint64_t copies_held_by_plans = 14;

/// Divides each take into segments[t] segments where robust PCA then errs least, as far as the
/// noisy data tell: the cost of a candidate segment is |A - M|_F^2, A its motion by `method` at the
/// coarse tolerance, M the running median of nine frames of the take. M is no better than A, but
/// its errors do not depend on the division. Plans are those of segment/cheapest_plan.hpp: half to
/// twice the equal length; takes too short to vary are divided equally. All candidates of all takes
/// of a width are solved in batches on the backend, about 35 times the frames of the takes; the
/// result of a take does not depend on the others. Throws what Backend::solve() throws, Cancelled
/// on a stop.
std::vector<SegmentPlan> cheapest_plans(std::span<const Recording> takes,
                                        std::span<const Index> segments, RobustPca method,
                                        Backend& backend, const std::stop_token& stop = {});

}  // namespace moclean
