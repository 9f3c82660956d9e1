#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "moclean/core/matrix.hpp"
#include "moclean/formats/format.hpp"

namespace moclean {

/// What a column of a table or array is.
enum class ColumnRole {
  coordinate,  ///< of a point
  confidence,  ///< how sure a point is; 0: it was not seen
  time,        ///< of the frame
  index,       ///< number of the frame
  angle,       ///< or a part of a quaternion
  plain,       ///< a channel by itself, cleaned where there are no points
  other        ///< anything else, kept as it is
};

/// A point of two or three coordinates.
struct ColumnPoint {
  std::string name;
  std::vector<std::size_t> columns;  ///< of x and y and, of three, z
  std::optional<std::size_t> confidence = {};
};

/// What the columns are, and which points they form.
struct ColumnRoles {
  std::vector<ColumnRole> roles;        ///< one per column
  std::vector<ColumnPoint> points;      ///< in the order of their first columns
  std::string example = {};             ///< a name that told of a point; empty where none did
  std::vector<std::string> names = {};  ///< of all columns, as the file has them

  /// The columns that become samples: those of points, x before y before z, and the plain ones, in
  /// the order in which points and channels begin.
  std::vector<std::size_t> sample_columns() const;

  /// Their names: `hip.x hip.y hip.z`, those of plain channels as in the file.
  std::vector<std::string> sample_names() const;

  /// Column `column` for a message: its name, or `column 3` if it has none.
  std::string shown(std::size_t column) const;

  /// What was understood: `19 points of three coordinates (names like 'LFHD:X')`.
  std::string described() const;
};

/// Tells roles by names, and by values where names do not tell.
///
/// A coordinate is named by its point and x, y or z in any case and order of columns
/// (axis_names()): `hip.x`, `x(hip)`, `hip X (mm)`, `hipX`; bare `X, Y, Z` may come again and
/// again. Letters written to a name without anything between count where there is a whole set of
/// them. Two coordinates without a third make a point in a picture. Sets whose name tells of
/// rotations, quaternions, velocities or forces are no points. Where there are points all else
/// passes through; where there are none, every column is a plain channel that is no time, index or
/// confidence, and has a name or values.
///
/// `first_rows` [rows x columns] are some values of the table, NaN where there are none: a column
/// without a name, or named `index`, `id` or the like, is a running index if it counts.
ColumnRoles recognise_columns(const std::vector<std::string>& names, const Matrix& first_rows);

/// Roles as a specification says: letters from left to right, `t` time, `i` index, `x` `y` `z`
/// coordinates (a new point begins where a letter comes again), `c` confidence of the point before,
/// `p` plain channel, `o` other, which passes through. `5(xyz)` is `xyz` five times, `(xyzc)*` as
/// often as there are columns left; commas and blanks between them do not count. `names` are those
/// of all columns; points are named after theirs where these tell one, else `point1`, ... Throws
/// ArgumentError for a specification that is none, or that has more or fewer columns than there
/// are.
ColumnRoles parse_column_roles(std::string_view specification,
                               const std::vector<std::string>& names);

/// Every column that is no time or index by its name is a coordinate of points of three or two, or
/// a plain channel. Throws ArgumentError if the number of columns does not fit. `layout` is not
/// automatic.
ColumnRoles columns_in_layout(ColumnLayout layout, const std::vector<std::string>& names,
                              const Matrix& first_rows);

}  // namespace moclean
