#pragma once

#include <filesystem>
#include <string_view>

#include "moclean/formats/format.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// Reads a NumPy array file (`.npy`, format 1.0, 2.0 or 3.0); `file` names it in messages.
///
/// float32 or float64 of either byte order, in C or Fortran order. The first axis counts frames;
/// the other axes, as in [frames x joints x 3], become columns in C order, and a one-dimensional
/// array is one column. Columns get default_column_names(); the format states no frame rate. Throws
/// FileError if the bytes are not exactly such a file.
Recording parse_npy(std::string_view bytes, const std::filesystem::path& file);

/// Writes the samples as float64 [frames x columns] in C order, format 1.0; names, frame rate and
/// unit have no place in it. Throws FileError.
void write_npy(AtomicFile& file, const Recording& clip);

/// NumPy arrays (.npy).
extern const Format npy_format;

}  // namespace moclean
