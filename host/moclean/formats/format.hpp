#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "moclean/formats/file.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// Frames A up to but not including B, counted from 0; either end may be left open.
struct FrameRange {
  std::optional<Index> first;
  std::optional<Index> last;
};

/// How the columns of tables and arrays become samples.
enum class ColumnLayout {
  automatic,  ///< by their names, or the shape of the array
  points3,    ///< x, y, z of a point, and so on, whatever the names
  points2,    ///< x, y of a point, and so on
  plain       ///< every column by itself
};

/// How a recording is read: what its file does not say, and which part of it is wanted.
struct ReadOptions {
  /// .asf: that of an .amc, else looked for in the .amc's folder; of other files without a skeleton
  /// of their own, if they have its joints.
  std::filesystem::path skeleton;
  double rate = 0;         ///< Hz for files that state none; 0: leave unknown
  FrameRange frames = {};  ///< formats read all; see read_recording()

  ColumnLayout layout = ColumnLayout::automatic;
  std::string columns = {};          ///< what every column is, see parse_column_roles(); or empty
  std::vector<double> missing = {};  ///< numbers that stand for a sample that was not observed
};

/// What files of a format say beside the positions.
struct FormatContent {
  bool names = false;             ///< of columns or joints
  bool frame_rate = false;        ///< a file may still leave it out
  bool unit = false;              ///< likewise
  bool up = false;                ///< likewise
  bool skeleton = false;          ///< and its channels
  bool gaps = false;              ///< a sample that was not observed can be told from any number
  bool single_precision = false;  ///< samples are rounded to float, whole points are missing
};

/// A file format: all that the program knows of it. Each has a pair of files, NAME.hpp and
/// NAME.cpp, with the only object of this type that describes it, and a line in formats.cpp. Error
/// and help texts and the table in README.md follow from these objects.
struct Format {
  std::string_view name;       ///< as people call it
  std::string_view extension;  ///< with its dot, in lower case; that of no other format
  std::string_view notes;      ///< one line of what its users should know; names between backticks
  FormatContent content = {};

  /// Makes a recording of the whole content of `file`. Throws FileError. Null: cannot be read.
  Recording (*read)(std::string_view content, const std::filesystem::path& file,
                    const ReadOptions& options) = nullptr;

  /// Throws FileError for a recording that the format has no way to say. Null: cannot be written.
  void (*write)(AtomicFile& file, const Recording& recording) = nullptr;
};

}  // namespace moclean
