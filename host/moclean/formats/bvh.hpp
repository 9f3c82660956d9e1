#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "moclean/formats/format.hpp"
#include "moclean/motion/skeleton.hpp"

namespace moclean {

/// A BVH file as written. The FramedSource::file of a recording is a shared pointer to it.
struct BvhDocument {
  /// A word of the text; nothing where the file does not have it.
  struct Word {
    std::size_t first = 0, size = 0;
  };

  std::string text;        ///< all of it: End Sites, replaced offsets, layout
  std::size_t motion = 0;  ///< where in it MOTION stands
  Word frames_word;        ///< behind `Frames:`
  Word time_word;          ///< behind `Frame Time:`
  std::size_t rows = 0;    ///< where the first frame begins
  std::size_t end = 0;     ///< of what is written again: all but a frame that breaks off

  double frame_time = 0;    ///< seconds; 0 where the file states none
  Index stated_frames = 0;  ///< by the file
  Index frames = 0;         ///< that were read
};

/// Reads Biovision Hierarchy text; `file` names it in messages, `rate` (Hz) is used in place of
/// what the file states if it is not 0. Throws FileError.
///
/// Any hierarchy (several ROOTs too) and any channels in any order. End Sites are read and left
/// out: they are no joints and have no channels. A position channel replaces its component of
/// OFFSET, on the root as on any other joint: that is how Blender's armature import and assimp read
/// files, and exporters that give every joint six channels repeat the offset in them. Positions are
/// applied before rotations wherever they stand. Joints of one name become `NAME`, `NAME_2`, ...
///
/// A frame is a line, or lines that together hold as many numbers, as the first one does. All
/// frames are read, however many the file states; a last one that breaks off is left out, text
/// behind them is kept: each with a warning. A channel may be missing (see
/// TextScanner::accept_number()); decimals may stand behind a comma. The frame rate is that of
/// rate_from_period(); the format states no unit.
SkeletonMotion parse_bvh(std::string_view text, const std::filesystem::path& file, double rate = 0);

/// Writes a recording with a skeleton and its channels. The positions of joints that were changed
/// become rotations by inverse_kinematics(). Throws FileError for a recording without.
///
/// One of a BVH file becomes such a file again, with its hierarchy, layout and numbers: every
/// channel that stays the same keeps its text, another one gets as many decimals as the file uses,
/// at least 4. A file of which nothing was changed comes back byte for byte, but for `Frames:`,
/// which is the number there are. Any other one becomes a new file, see write_new_bvh().
void write_bvh(AtomicFile& file, const Recording& recording);

/// Writes channels of a recording's skeleton as a new BVH file, whatever file it comes from.
///
/// Bones that BVH can say (no constant rotations, the joint where they turn) keep offset, channels
/// and their order. Others become Zrotation Yrotation Xrotation with the constant rotations of
/// Bone::before and after in them; a bone whose joint is its far end (ASF) turns at the joint of
/// its parent, or, where that one has other children, at a joint `NAME_start` of its own in the
/// same place. So every joint has its position under its name. Numbers have as many decimals as
/// keep positions to 1e-7 of the body. A recording without a frame rate is written with 120 Hz,
/// that of the public collections of ASF/AMC files (CMU, HDM05).
void write_new_bvh(AtomicFile& file, const Recording& recording, const Matrix& channels);

/// Biovision Hierarchy (.bvh).
extern const Format bvh_format;

}  // namespace moclean
