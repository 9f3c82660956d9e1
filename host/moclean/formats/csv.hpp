#pragma once

#include <filesystem>
#include <string_view>

#include "moclean/formats/format.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// Reads comma-separated values; `file` names them in messages. Throws FileError.
///
/// Comment lines (`#`) may come first, of which `# frame_rate: 120`, `# unit: mm` and `# up: z` (x,
/// y or z) are understood; then one line of column names, perhaps one of units, then a line per
/// frame. Where there is no line of names, the last comment may hold them, as numpy.savetxt writes
/// it. The separator is comma, semicolon or tab, or blanks between words. Names and cells may stand
/// in double quotes. UTF-8 and UTF-16. Tables of Motive, Vicon Nexus, QTM, DeepLabCut and Anipose
/// are known by their first lines. How columns become samples, and what cells may say:
/// docs/formats.md.
Recording parse_csv(std::string_view text, const std::filesystem::path& file,
                    const ReadOptions& options = {});

/// Writes a recording that parse_csv() read into the text it was read from: the same file, but for
/// samples that have other values now. Any other becomes a new table that reads back to the same
/// bits. Throws FileError.
void write_csv(AtomicFile& file, const Recording& recording);

/// Comma-separated values (.csv).
extern const Format csv_format;

}  // namespace moclean
