#include "moclean/body/splices.hpp"

#include <algorithm>

namespace moclean {
namespace {

constexpr double moved_share = 0.3, whole_share = 0.8;

}  // namespace

std::vector<Index> splices(const Mask& trusted, std::span<const SuddenSteps> steps,
                           const RigidBody& body, const Mask& jumps) {
  std::vector<Index> testable;
  for (std::size_t j = 0; j < body.testable.size(); ++j)
    if (body.testable[j]) testable.push_back(static_cast<Index>(j));
  const auto share = [&](const auto& holds) {
    const auto count = std::ranges::count_if(testable, holds);
    return static_cast<double>(count) / static_cast<double>(testable.size());
  };
  const auto is_whole = [&](Index frame) {
    return share([&](Index j) { return trusted(frame, j); }) >= whole_share;
  };
  const auto has_moved = [&](Index step) {
    return share([&](Index j) {
             const std::vector<bool>& sudden = steps[static_cast<std::size_t>(j)].sudden;
             return !sudden.empty() && sudden[static_cast<std::size_t>(step)] && !jumps(step, j) &&
                    !jumps(step + 1, j);
           }) >= moved_share;
  };
  std::vector<Index> found;
  if (testable.empty()) return found;
  for (Index step = 0; step + 1 < trusted.rows(); ++step) {
    if (!has_moved(step)) continue;
    const Index before = step;
    while (step + 2 < trusted.rows() && has_moved(step + 1)) ++step;
    if (is_whole(before) && is_whole(step + 1)) found.push_back(before + 1);
  }
  return found;
}

}  // namespace moclean
