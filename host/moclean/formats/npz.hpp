#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "moclean/formats/format.hpp"
#include "moclean/formats/npy.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// What an .npz file holds beside the positions; the FramedSource::file of a recording of one.
struct NpzDocument {
  std::shared_ptr<const std::string> content;  ///< of the file
  std::string member;                          ///< the array of the positions: `positions.npy`
  NpyDocument array;                           ///< likewise
};

/// Reads several arrays as numpy.savez saves them: positions, and names, rate and unit where there
/// are any. `file` names it in messages.
///
/// The positions are the member `positions`, `joints`, `markers`, `keypoints` or another known
/// name, else the only array of numbers with three axes, else with two. Names are a member of text
/// (`names`, `joint_names`, `labels`, ...) with one per point or per column; the rate `fps`,
/// `mocap_framerate`, `frame_rate`, ...; the unit `unit` or `units`. Members that are pickled are
/// passed over. Throws FileError, of rotations without positions (AMASS: `poses`) with the reason.
Recording parse_npz(std::string_view content, const std::filesystem::path& file,
                    const ReadOptions& options = {});

/// Writes the archive with other positions, all other members as they are. A recording from
/// elsewhere becomes `positions` (frames, points, 3) or, where it has other columns, `samples`
/// (frames, columns), with `names`, `fps` and `unit` where they are known.
void write_npz(AtomicFile& file, const Recording& recording);

/// NumPy arrays (.npz).
extern const Format npz_format;

}  // namespace moclean
