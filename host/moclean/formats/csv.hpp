#pragma once

#include <filesystem>
#include <string_view>

#include "moclean/formats/format.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// Reads comma-separated values; `file` names them in messages. Throws FileError.
///
/// Comment lines (`#`) may come first, of which `# frame_rate: 120`, `# unit: mm` and
/// `# up: z` (x, y or z) are understood; then one line of column names, then a line per frame. The
/// separator is the first of comma, semicolon and tab that occurs in the line of names; names may
/// stand in double quotes. A sample is a number, or NaN if it is empty or says `nan`; `inf` is read
/// as infinity. A first column named `time`, `t`, `t(s)`, `time(s)`, `t[s]` or `time[s]` (any case,
/// blanks do not count) holds increasing seconds: it is dropped, and gives the frame rate unless a
/// comment does.
Recording parse_csv(std::string_view text, const std::filesystem::path& file);

/// Writes what parse_csv() reads back to the same bits: the shortest text for every number, `nan`
/// for any NaN. Throws FileError.
void write_csv(AtomicFile& file, const Recording& clip);

/// Comma-separated values (.csv).
extern const Format csv_format;

}  // namespace moclean
