#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "moclean/formats/column_roles.hpp"
#include "moclean/formats/format.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// A piece of a text.
struct TextSpan {
  std::size_t begin = 0;
  std::size_t length = 0;
};

/// Where the rows of a table stand in its text, and what its head says of them.
struct TableShape {
  std::string dialect = {};  ///< the program that writes such heads; empty for a plain table
  char separator = ',';
  char decimal = '.';
  std::size_t rows = 0;                           ///< where the first row begins, in bytes
  std::size_t rows_end = std::string_view::npos;  ///< where the table ends
  std::size_t first_line = 1;                     ///< number of the first row's line
  ColumnRoles roles = {};                         ///< of all columns
  std::size_t least_cells = 0;                    ///< empty ones behind them may be left out
  double rate = 0;                                ///< Hz, as stated; 0 if it is not
  std::optional<TextSpan> rate_text = {};         ///< where it is stated
  std::vector<TextSpan> count_texts = {};         ///< where the number of frames is
  std::string unit = {};
  std::optional<UpAxis> up = {};
  std::vector<std::string> other_parts = {};  ///< of the file, that are no rows of this table
};

/// The text of a table, for those who recognise its head.
struct TableText {
  std::string_view text;
  const std::filesystem::path& file;  ///< for messages
  std::string_view extension;         ///< of the format that it is read as
  const ReadOptions& options;
};

/// The cells of a line as names.
std::vector<std::string> cells_of_line(std::string_view line, char separator);

/// The first values of the columns of a table, [rows x columns], NaN where a cell is no number.
Matrix first_values(std::string_view text, const TableShape& shape, std::size_t columns);

/// Cells before the empty names at the end.
std::size_t named_columns(const std::vector<std::string>& names);

/// The heads that are known: nothing if a file begins otherwise. They throw FileError if it begins
/// so, but goes on otherwise, or holds what cannot be read.
std::optional<TableShape> motive_shape(const TableText& table);
std::optional<TableShape> nexus_shape(const TableText& table);
std::optional<TableShape> qtm_shape(const TableText& table);
std::optional<TableShape> pose_shape(const TableText& table);
std::optional<TableShape> storage_shape(const TableText& table);

/// A head of several lines as pandas writes it for columns of several levels: one of them tells the
/// coordinates, the others whose they are.
std::optional<TableShape> levels_shape(const TableText& table);

/// Any other table: comments, a line of names, rows. Throws FileError.
TableShape plain_shape(const TableText& table);

/// Throws FileError for a table with a row per point ("long", "tidy"): of one or two points, with a
/// column such as `keypoint` or `track` that tells whose a row is and is not always the same.
void refuse_long_table(const TableText& table, const TableShape& shape);

}  // namespace moclean
