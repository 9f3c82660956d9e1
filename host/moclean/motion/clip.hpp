#pragma once

#include <string>
#include <vector>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// A recording as a matrix: one row per frame, one column per channel.
///
/// A clip read from a skeleton file holds joint positions, three columns (x, y, z) per joint, named
/// `Joint.x`, `Joint.y`, `Joint.z`. A sample that was not observed is NaN; there is no other mark.
struct Clip {
  Matrix samples;                    ///< [frames x columns]
  std::vector<std::string> columns;  ///< one name per column
  double frame_rate = 0;             ///< Hz; 0 where unknown
  std::string unit;                  ///< length unit as the file states it; empty where it does not

  Index frames() const { return samples.rows(); }
};

/// Channels that belong together: the x, y, z of one joint or marker, or a single column.
struct Joint {
  std::string name;
  Index first_column = 0;
  Index columns = 3;  ///< 3, or 1 for a channel that stands alone
};

/// Splits the columns of a clip into joints. Three neighbours named `N.x N.y N.z` are joint `N`,
/// as are those of other tools: `N_x`, `N-x`, `N:x`, `N x`, `N.X`, `x.N`. Any other column is a
/// joint of its own.
std::vector<Joint> joints(const Clip& clip);

/// Names for `count` columns of a file that has none: `joint0.x joint0.y joint0.z joint1.x ...`
/// when count is a multiple of 3, else `column0 column1 ...`.
std::vector<std::string> default_column_names(Index count);

/// The rows [first, last) of a clip as a clip. Throws ShapeError unless 0 <= first < last <=
/// frames.
Clip cut(const Clip& clip, Index first, Index last);

}  // namespace moclean
