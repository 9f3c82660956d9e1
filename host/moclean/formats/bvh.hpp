#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "moclean/formats/format.hpp"
#include "moclean/motion/skeleton.hpp"

namespace moclean {

/// What a BVH file says beside skeleton and channels; the Recording::source of one.
struct BvhDocument {
  std::string
      hierarchy;  ///< all text before MOTION, as written: End Sites, replaced offsets, layout
  double frame_time = 0;  ///< seconds, as written

  std::string motion;       ///< all text from MOTION on, as written
  std::size_t rows = 0;     ///< where the frames begin in it, in bytes
  Index stated_frames = 0;  ///< by the file
  Index all_frames = 0;     ///< that were read
  Index first_frame = 0;    ///< of the file, that is frame 0 of the recording
  Index frames = 0;         ///< of the recording; if it has others, the text of rows is no use
};

/// Reads Biovision Hierarchy text; `file` names it in messages. Throws FileError.
///
/// Any hierarchy (several ROOTs too) and any channels in any order. End Sites are read and left
/// out: they are no joints and have no channels. A position channel replaces its component of
/// OFFSET, on the root as on any other joint: that is how Blender's armature import and assimp read
/// files, and exporters that give every joint six channels repeat the offset in them. Positions are
/// applied before rotations wherever they stand. A frame is a line; lines beyond the stated number
/// of frames are left out, as assimp does (a real take, Boxing_Toes.bvh, states one too few). The
/// frame rate is that of rate_from_period(); the format states no unit.
SkeletonMotion parse_bvh(std::string_view text, const std::filesystem::path& file);

/// Writes a recording of a BVH file as such a file again: its hierarchy, layout and numbers. The
/// positions of joints that were changed become rotations by inverse_kinematics(); every channel
/// that stays the same keeps its text, another one gets as many decimals as the file uses, at least
/// 4. A file of which nothing was changed comes back byte for byte. Throws FileError for a
/// recording without a BVH file's skeleton and channels.
void write_bvh(AtomicFile& file, const Recording& recording);

/// Biovision Hierarchy (.bvh).
extern const Format bvh_format;

}  // namespace moclean
