#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "moclean/formats/format.hpp"
#include "moclean/formats/npy_array.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// What an array of positions says beside them; the FramedSource::file of a recording of one. It is
/// written again with its shape, its type and the numbers that are no samples.
struct NpyDocument {
  std::shared_ptr<const std::string>
      content;                       ///< of the file; null where only shape and type count
  NpyArray array;                    ///< of all frames; its items lie in the content
  std::vector<Index> samples;        ///< columns of the flattened array that are samples
  std::vector<std::string> columns;  ///< what the recording calls them
  std::vector<Index> confidences;    ///< per sample that of its point, or -1
  double least_confidence = 1;       ///< of points that were filled
  std::vector<double> missing;       ///< numbers that stand for a missing sample
};

/// Reads an array as NumPy saves it, see columns_of_array() for what its shape may be: float16,
/// float32, float64 and integers of any size, in either byte order and in the order of C or
/// Fortran. A point whose confidence is 0 is missing. `file` names it in messages. Throws
/// FileError.
Recording parse_npy(std::string_view content, const std::filesystem::path& file,
                    const ReadOptions& options = {});

/// Writes the array that NumPy reads: of the shape, type and byte order of the array that was read,
/// with the numbers that are no samples as they were, in the order of C; whole numbers are rounded,
/// and become float64 where a sample is missing or beyond their range. A point that is missing for
/// its confidence or for a mark and still is keeps its numbers; one of confidence 0 that has
/// coordinates now gets the least confidence above 0. Recordings from elsewhere become
/// float64, (frames, columns), without names and rate (NPZ has both).
void write_npy(AtomicFile& file, const Recording& recording);

/// The bytes of that file.
std::string npy_text(const Recording& recording);

/// A recording of an array that was taken apart; `content`, where its items lie, is kept only where
/// writing needs it.
Recording recording_of(const NpyArray& array, const std::filesystem::path& file,
                       const ReadOptions& options);

/// NumPy array (.npy).
extern const Format npy_format;

}  // namespace moclean
