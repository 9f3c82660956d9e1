#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "moclean/formats/table_shape.hpp"

namespace moclean {

/// A cell that is no number where one is expected.
struct UnreadableCell {
  std::size_t line = 0;    ///< from 1
  std::size_t column = 0;  ///< from 0
  std::string text;
};

/// The rows of a table.
struct TableRows {
  Matrix samples;                         ///< [frames x sample columns]
  std::vector<double> times;              ///< as the file has them; empty without a time column
  bool are_clock_times = false;           ///< then `times` are in seconds, from the first one
  std::size_t repeated_times = 0;         ///< of frames that have the time of the one before
  std::vector<double> confidences;        ///< [frames x points with a confidence]
  std::string missing_text;               ///< the first missing sample as the file spells it
  std::optional<UnreadableCell> stopped;  ///< at which the rest was left unread
};

/// Reads the rows between shape.rows and shape.rows_end; blank lines and comments (`#`) are none.
/// Throws FileError for a row that has more or fewer cells than there are columns, for infinite
/// samples and, if `checks_times`, for times and frame numbers that do not grow; times may stand
/// still in one frame of a hundred.
TableRows read_rows(std::string_view text, const TableShape& shape,
                    const std::filesystem::path& file, bool checks_times);

/// What the cells of a table, or of its first rows, are, without regard to what they should be.
struct TableSurvey {
  std::vector<std::size_t> numbers;  ///< per column
  std::size_t with_point = 0;        ///< cells with a decimal point in columns that are used
  std::size_t with_comma = 0;        ///< cells with a decimal comma, likewise
};
TableSurvey survey_rows(std::string_view text, const TableShape& shape,
                        std::size_t most_rows = static_cast<std::size_t>(-1));

/// Whether a line between rows is none of them: blank, or a comment.
bool is_no_row(std::string_view line, char separator);

}  // namespace moclean
