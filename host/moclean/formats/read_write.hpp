#pragma once

#include <filesystem>

#include "moclean/formats/file.hpp"
#include "moclean/motion/clip.hpp"

namespace moclean {

/// What a reader cannot find in the file itself.
struct ReadOptions {
  std::filesystem::path skeleton;  ///< .asf for an .amc; empty: look in the .amc's folder
  double rate = 0;                 ///< Hz for files that state none; 0: leave unknown
};

/// Reads a recording; the extension chooses the format (.bvh, .amc, .csv, .npy; any case).
/// Skeleton formats become joint positions, three columns per joint; what a format means in detail
/// stands in its header (bvh.hpp, asf.hpp, amc.hpp, csv.hpp, npy.hpp). There is at least one frame
/// and one column. Throws FileError for an unknown extension, a file that cannot be opened, and
/// anything in it that does not parse.
Clip read_clip(const std::filesystem::path& file, const ReadOptions& options = {});

/// Writes a clip as .csv or .npy (float64, [frames x columns]); other extensions throw FileError.
/// The file appears under its name only when it is complete (temporary file, then rename).
void write_clip(const std::filesystem::path& file, const Clip& clip);

/// As write_clip(), but leaves the complete file under its temporary name: commit() puts it in its
/// place, the destructor removes it.
AtomicFile write_temporary(const std::filesystem::path& file, const Clip& clip);

}  // namespace moclean
