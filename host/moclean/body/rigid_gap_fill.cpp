#include "moclean/body/rigid_gap_fill.hpp"

namespace moclean {
namespace {

// The blend of what each edge says of a frame.
template <class FromEdge>
Matrix blended(const Gap& gap, const Frames& frames, const FromEdge& from_edge) {
  Matrix positions = Matrix::Zero(static_cast<Index>(frames.size()), 3);
  for (Index i = 0; i < positions.rows(); ++i) {
    const Index frame = frames[static_cast<std::size_t>(i)];
    const double late = !gap.after ? 0 : !gap.before ? 1 : place(gap, frame);
    if (late < 1) positions.row(i) += (1 - late) * from_edge(gap.first - 1, frame);
    if (late > 0) positions.row(i) += late * from_edge(gap.last, frame);
  }
  return positions;
}

}  // namespace

Matrix rigid_gap_fill(const BodyTake& take, const Neighbours& neighbours, const Gap& gap,
                      const Frames& frames) {
  return blended(gap, frames, [&](Index edge, Index frame) {
    return rigid_motion(take, neighbours, edge, frame).moved(take.position(edge, gap.joint));
  });
}

Matrix held(const BodyTake& take, const Gap& gap, const Frames& frames) {
  return blended(gap, frames, [&](Index edge, Index) -> Eigen::RowVector3d {
    return take.position(edge, gap.joint);
  });
}

}  // namespace moclean
