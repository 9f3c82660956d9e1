#pragma once

#include <any>
#include <optional>
#include <string>
#include <vector>

#include "moclean/core/matrix.hpp"
#include "moclean/motion/skeleton.hpp"

namespace moclean {

/// The axis that points upwards.
enum class UpAxis { x, y, z };

/// What reading a file found out that its user should hear of.
struct ReadingNotes {
  std::string layout = {};                 ///< how the columns were understood, and why
  std::vector<std::string> warnings = {};  ///< sentences, without the file's name
  std::vector<std::string> passed_through =
      {};  ///< columns of the file that are no samples; kept in the source as they are
};

/// A recording and all that its file tells: one row of samples per frame, one column per channel,
/// what they are, and what the file needs to be written again.
///
/// One read from a skeleton file holds joint positions, three columns (x, y, z) per joint, named
/// `Joint.x`, `Joint.y`, `Joint.z`. A sample that was not observed is NaN; there is no other mark.
struct Recording {
  Matrix samples;                    ///< [frames x columns]
  std::vector<std::string> columns;  ///< one name per column
  double frame_rate = 0;             ///< Hz; 0 where unknown
  std::string unit;                  ///< length unit as the file states it; empty where it does not
  std::optional<UpAxis> up = {};     ///< where the file states it

  /// That the joints belong to, see joint_parents(); of the file, or given beside it.
  std::optional<Skeleton> skeleton = {};

  /// What drives the skeleton in the file, [frames x skeleton->channels()], translations in file
  /// units, radians. It is not changed with the samples. 0 x 0 where the file has only positions.
  Matrix channels = {};

  /// How sure a sample is, [frames x columns], above 0, of any scale: the variance of its noise is
  /// taken for one over that. NaN: the file does not say. 0 x 0 where it says so of none. A sample
  /// that its file has no confidence in at all (0) is missing.
  Matrix confidence = {};

  /// What else the file's format keeps to write the same file again, of a type of the format's own
  /// (named in its header); empty where that is nothing.
  std::any source = {};

  ReadingNotes notes = {};

  Index frames() const { return samples.rows(); }
};

/// Channels that belong together: the x, y, z of one joint or marker, the x, y of a point in a
/// picture, or a single column.
struct Joint {
  std::string name;
  Index first_column = 0;
  Index columns = 3;  ///< 3, 2, or 1 for a channel that stands alone
};

/// Splits the columns of a recording into joints. Three neighbours named `N.x N.y N.z` are joint
/// `N`, as are those of other tools: `N_x`, `N-x`, `N:x`, `N x`, `N.X`, `x.N`. Two that have no z
/// behind them are a joint of two columns. Any other column is a joint of its own.
std::vector<Joint> joints(const Recording& recording);

/// Names for `count` columns of a file that has none: `joint0.x joint0.y joint0.z joint1.x ...`
/// when count is a multiple of 3, else `column0 column1 ...`.
std::vector<std::string> default_column_names(Index count);

/// The frames [first, last) with all that is known of them. Throws ShapeError unless 0 <= first <
/// last <= frames.
Recording excerpt(const Recording& recording, Index first, Index last);

/// Every so many frames, from the first, at a rate that is as much lower; `every` is at least 1.
Recording thinned(const Recording& recording, Index every);

/// Other samples under the names of a recording, at its rate and in its unit: something about it,
/// not it, so without confidence, skeleton and source.
Recording like(const Recording& recording, Matrix samples);

/// Some columns of a recording; without skeleton and source, for joints may be missing.
Recording columns_of(const Recording& recording, const std::vector<Index>& columns);

/// The joint positions of a motion of a skeleton, which they keep; columns are named after the
/// bones.
Recording joint_positions(SkeletonMotion motion);

/// Per joint of joints(recording) the joint it hangs on, -1 for a root. Empty unless the joints are
/// the skeleton's bones: as many, three columns each, under the same names in the same order.
std::vector<int> joint_parents(const Skeleton& skeleton, const Recording& recording);

/// Those by the recording's own skeleton; empty if it has none.
std::vector<int> joint_parents(const Recording& recording);

}  // namespace moclean
