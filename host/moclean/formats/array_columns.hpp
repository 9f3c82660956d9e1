#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "moclean/formats/format.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// Which numbers of an array are the samples of a recording.
struct ArrayColumns {
  std::vector<Index> samples;      ///< columns of the flattened array, in the order of points
  std::vector<std::string> names;  ///< one per sample column
  std::vector<Index> confidences;  ///< per sample column that of its point's confidence, or -1
  ReadingNotes notes;
};

/// Tells from shape and numbers what the columns of an array are. `numbers` is [frames x all other
/// axes, the last one fastest]. ReadOptions::columns goes before all else.
///
/// (frames), (frames, columns): as many columns, points of three if 3 divides them; (frames,
/// points, 3) and (frames, points, 2): points; (frames, points, 3) whose third number lies within 0
/// to 1 while the others span a picture: x, y and a confidence; (frames, points, 4): x, y, z and a
/// confidence within 0 to 1; another last axis: plain channels, with a warning. ReadOptions::layout
/// decides otherwise. A warning where the second axis rather than the first looks like time.
///
/// Throws FileError with the likely reason for arrays of more axes (a batch of takes, rotation
/// matrices), with the axes of points first ((3, points, frames)) or second, for unit quaternions,
/// and for a layout that does not divide the columns.
ArrayColumns columns_of_array(const std::vector<std::uint64_t>& shape, const Matrix& numbers,
                              const std::filesystem::path& file, const ReadOptions& options);

/// Throws FileError for a shape that columns_of_array() refuses whatever its numbers are.
void require_readable_shape(const std::vector<std::uint64_t>& shape,
                            const std::filesystem::path& file);

}  // namespace moclean
