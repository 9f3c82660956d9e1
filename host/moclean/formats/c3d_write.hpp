#pragma once

#include "moclean/core/matrix.hpp"
#include "moclean/formats/c3d_file.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// Writes the file that a recording was read from, with its frames from `first` on and its
/// coordinates, see c3d_format. Its columns are those of `c3d`. Throws FileError.
void write_in_c3d(AtomicFile& file, const C3dFile& c3d, Index first, const Recording& recording);

/// Writes a recording of another format: reals of Intel, groups POINT, ANALOG (without channels)
/// and TRIAL. Throws FileError for columns that are no coordinates of points.
void write_new_c3d(AtomicFile& file, const Recording& recording);

}  // namespace moclean
