#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "moclean/formats/c3d_file.hpp"
#include "moclean/formats/format.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// The FramedSource::file of a recording that was read from a C3D file: all of it, so that it can
/// be written again with other coordinates.
struct C3dSource {
  std::shared_ptr<const C3dFile> c3d;
};

/// Reads a C3D file (https://www.c3d.org/HTML); `file` names it in messages. Throws FileError
/// naming the byte where that helps.
///
/// Integers and reals, of Intel, DEC and MIPS. Columns are `LABEL.x`, `LABEL.y`, `LABEL.z` per
/// point; one without a label is `point7` by its number, one with another's label `LABEL_2`. Rate,
/// unit (POINT:UNITS) and up are what the file states. A sample is NaN where the point is invalid
/// (residual -1, stored as any word with its sign bit set), or at 0,0,0 exactly and not measured
/// (residual and cameras 0) while the point is elsewhere in other frames; coordinates that are
/// stored as NaN are NaN. Results of a model (POINT:ANGLES, FORCES, MOMENTS, POWERS, SCALARS) are
/// no coordinates and have no columns; they are kept, as are analog channels, events and all
/// parameters. A file without points, or with fewer frames than it states, is refused.
Recording parse_c3d(std::string_view bytes, const std::filesystem::path& file);

/// Writes a recording that was read from a C3D file as that file, all bytes the same but the
/// samples that were changed, which have residual and cameras 0 then, or residual -1 and
/// coordinates 0 where they are missing now; a group MOCLEAN lists per point how many were FILLED,
/// CORRECTED and REMOVED. The numbers have the file's type; integers become reals if one of them
/// does not fit. Part of a recording keeps the analog samples of its frames and their numbers in
/// the trial. Any other recording becomes a new file of reals (single precision): its points have
/// residual 0, a point of which a coordinate is missing is invalid. Throws FileError.
void write_c3d(AtomicFile& file, const Recording& recording);

/// Coordinate 3D files of motion laboratories (.c3d).
extern const Format c3d_format;

}  // namespace moclean
