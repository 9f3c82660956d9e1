#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "moclean/formats/format.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// What a TRC file says beside the markers' positions; the Recording::source of one. The whole text
/// is kept, so that header, Frame# and Time columns, the spelling of every number that was not
/// changed, and the trajectories that have no name are written as they were read.
struct TrcDocument {
  std::string text;                  ///< of the file
  std::size_t rows = 0;              ///< where the first row of samples begins in it, in bytes
  std::size_t first_line = 0;        ///< number of that line, from 1
  Index first_frame = 0;             ///< of the file, that is frame 0 of the recording
  Index frames = 0;                  ///< of the recording; of another number, the source is no use
  std::vector<std::string> columns;  ///< likewise
  double frame_rate = 0;             ///< likewise, Hz; -1 if its Time column contradicts
  std::string unit;                  ///< likewise
};

/// Reads Track Row Column text, as OpenSim, Motion Analysis (EVaRT, Cortex), Mokka and Pose2Sim
/// write it; `file` names it in messages. Throws FileError. The format is defined by its examples:
/// OpenSim's documentation, "Marker (.trc) Files", tells of five header lines (PathFileType, names
/// of settings, their values, `Frame# Time` and the markers, X1 Y1 Z1 ...), an empty line that may
/// be left out, and a row per frame.
///
/// Cells stand between tabs where a line has any, else they are words. A cell between tabs that is
/// empty or says `nan` is a missing sample, as are those of a row that ends early behind a whole
/// marker; in a row without tabs only `nan` can say so. `NumFrames` is not relied on: every row is
/// a frame. `NumMarkers` may be larger than the number of names (Cortex counts trajectories without
/// a name): cells behind the named ones then belong to those, they are kept in the source and are
/// no samples. Columns are named `Marker.x`, `.y`, `.z`, the unit is as stated. The rate is
/// DataRate; a Time column that tells another one is an error (unless the options state a rate).
Recording parse_trc(std::string_view text, const std::filesystem::path& file,
                    const ReadOptions& options = {});

/// Writes markers as OpenSim reads them: tabs, blanks for missing samples.
///
/// A recording of parse_trc() that still has its columns, frames, rate and unit is written as it
/// was read, to the byte, but for samples that were changed, which get as many decimals as the file
/// uses (at least 4, of metres 6), rows that ended early, and a wrong `NumFrames`. Any other gets a
/// header of its own and the shortest text that reads back as the same number. Positions in "ASF
/// units" become millimetres; where no unit is known, `Units` says `unknown`. Throws FileError for
/// columns that are no x, y, z of a marker and where no rate is known.
void write_trc(AtomicFile& file, const Recording& recording);

/// Track Row Column (.trc).
extern const Format trc_format;

}  // namespace moclean
