#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "moclean/formats/column_names.hpp"
#include "moclean/formats/table_cells.hpp"
#include "moclean/formats/table_number.hpp"
#include "moclean/formats/table_points.hpp"
#include "moclean/formats/table_shape.hpp"
#include "moclean/formats/text_lines.hpp"

namespace moclean {
namespace {

using Cells = std::vector<std::string>;

bool is_coordinate_cell(const std::string& cell) {
  return axis_of_cell(cell) < 3 || named_quantity(cell) == NamedQuantity::confidence;
}

// Lines of a head of several levels: of columns of the table, with the names of its first columns
// below them, if these have any.
class LevelsHead {
 public:
  explicit LevelsHead(const TableText& table) : lines_(table.text) {}

  std::optional<TableShape> shape() {
    if (!collect() || !tell_coordinates()) return std::nullopt;
    shape_.dialect = "pandas table";
    shape_.rows = lines_.position();
    shape_.first_line = lines_.number() + 1;
    shape_.least_cells = width_;
    shape_.roles = roles();
    if (shape_.roles.points.empty()) return std::nullopt;
    return std::move(shape_);
  }

 private:
  static constexpr std::size_t most_levels = 5;

  // Takes lines up to the first row. All have the width of the first, and a cell over every column
  // but the first few; the names of these stand in the last line, alone.
  bool collect() {
    for (TextLines next = lines_; next.next(); lines_ = next) {
      if (levels_.empty()) {
        if (next.line().empty()) return false;
        separate(next.line());
      }
      Cells cells = cells_of_line(next.line(), shape_.separator);
      if (levels_.empty()) width_ = cells.size();
      if (cells.size() != width_ || width_ < 3) return false;
      double value = 0;
      if (table_number(cells.back(), '.', value) || says_missing(cells.back())) {
        const bool are_names = !levels_.empty() && index_names_.empty() && !cells[0].empty() &&
                               !table_number(cells[0], '.', value) && is_alone(cells);
        if (!are_names) return levels_.size() > 1;
        index_names_ = std::move(cells);
        continue;
      }
      if (!index_names_.empty() || levels_.size() == most_levels) return false;
      levels_.push_back(std::move(cells));
    }
    return false;
  }

  void separate(std::string_view line) {
    for (const char candidate : {'\t', ';', ','})
      if (line.find(candidate) != std::string_view::npos) shape_.separator = candidate;
  }

  // Whether the cells behind the first columns are empty.
  bool is_alone(const Cells& cells) const {
    for (std::size_t c = 1; c < cells.size(); ++c)
      if (!cells[c].empty() && !levels_[0][c].empty()) return false;
    return true;
  }

  // The level of x, y and z. A table of one level of names over them, without anything before the
  // columns that would tell of levels, is a plain one.
  bool tell_coordinates() {
    while (first_ < width_ && (first_ == 0 || levels_[0][first_].empty())) ++first_;
    const auto are_coordinates = [&](const Cells& cells) {
      return std::all_of(cells.begin() + static_cast<std::ptrdiff_t>(first_), cells.end(),
                         is_coordinate_cell);
    };
    const auto place = std::ranges::find_if(levels_, are_coordinates);
    if (first_ == width_ || place == levels_.end()) return false;
    coordinates_ = static_cast<std::size_t>(place - levels_.begin());
    for (std::size_t l = 0; l < levels_.size(); ++l)
      for (std::size_t c = first_; c < width_; ++c)
        if (levels_[l][c].empty()) return false;
    const bool is_plain = levels_.size() == 2 && coordinates_ == 1 && index_names_.empty() &&
                          levels_[0][first_ - 1].empty();
    return !is_plain;
  }

  // Levels that are the same for all columns tell nothing, unless there is no other.
  std::vector<std::size_t> naming_levels() const {
    std::vector<std::size_t> found, all;
    for (std::size_t l = 0; l < levels_.size(); ++l) {
      if (l == coordinates_) continue;
      all.push_back(l);
      const auto first = levels_[l].begin() + static_cast<std::ptrdiff_t>(first_);
      if (std::any_of(first, levels_[l].end(), [&](const auto& cell) { return cell != *first; }))
        found.push_back(l);
    }
    if (found.empty()) found.push_back(all.back());
    return found;
  }

  ColumnRoles roles() {
    index_names_.resize(width_);
    Cells owners(width_), names;
    const std::vector<std::size_t> naming = naming_levels();
    for (std::size_t c = 0; c < width_; ++c) {
      for (const std::size_t l : naming)
        if (c >= first_) owners[c] += (owners[c].empty() ? "" : ":") + levels_[l][c];
      names.push_back(c < first_ ? index_names_[c] : owners[c] + " " + levels_[coordinates_][c]);
    }
    TablePoints points(names);
    for (std::size_t c = 0; c < first_; ++c) {
      const NamedQuantity quantity = named_quantity(index_names_[c]);
      if (quantity == NamedQuantity::time) points.set(c, ColumnRole::time);
      const bool counts = quantity == NamedQuantity::frame || quantity == NamedQuantity::running;
      if (counts) points.set(c, ColumnRole::index);
    }
    for (std::size_t c = first_; c < width_; ++c) {
      const std::string& coordinate = levels_[coordinates_][c];
      if (const std::size_t axis = axis_of_cell(coordinate); axis < 3)
        points.coordinate(c, owners[c], owners[c], axis);
      else
        points.confidence(c, owners[c]);
    }
    return points.roles();
  }

  TextLines lines_;
  TableShape shape_;
  std::vector<Cells> levels_;
  Cells index_names_;
  std::size_t width_ = 0, first_ = 0, coordinates_ = 0;
};

}  // namespace

std::optional<TableShape> levels_shape(const TableText& table) { return LevelsHead(table).shape(); }

}  // namespace moclean
