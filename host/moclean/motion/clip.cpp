#include "moclean/motion/clip.hpp"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

constexpr std::array<std::string_view, 3> axes = {".x", ".y", ".z"};

// Length of N if the three names from `first` on read `N.x N.y N.z`, else npos.
std::size_t joint_name_length(const std::vector<std::string>& columns, std::size_t first) {
  if (first + axes.size() > columns.size()) return std::string::npos;
  const std::string_view x = columns[first];
  if (!x.ends_with(axes[0])) return std::string::npos;
  const std::string_view name = x.substr(0, x.size() - axes[0].size());
  for (std::size_t i = 1; i < axes.size(); ++i) {
    const std::string_view column = columns[first + i];
    if (column.size() != x.size() || !column.starts_with(name) || !column.ends_with(axes[i]))
      return std::string::npos;
  }
  return name.size();
}

}  // namespace

std::vector<Joint> joints(const Clip& clip) {
  std::vector<Joint> found;
  for (std::size_t column = 0; column < clip.columns.size();) {
    const std::size_t length = joint_name_length(clip.columns, column);
    const Index width = length == std::string::npos ? 1 : 3;
    // substr takes npos as "the whole name".
    found.push_back({clip.columns[column].substr(0, length), static_cast<Index>(column), width});
    column += static_cast<std::size_t>(width);
  }
  return found;
}

std::vector<std::string> default_column_names(Index count) {
  std::vector<std::string> names;
  for (Index i = 0; i < count; ++i)
    names.push_back(count % 3 == 0
                        ? fmt::format("joint{}{}", i / 3, axes[static_cast<std::size_t>(i % 3)])
                        : fmt::format("column{}", i));
  return names;
}

Clip cut(const Clip& clip, Index first, Index last) {
  if (first < 0 || first >= last || last > clip.frames())
    throw ShapeError(fmt::format("cannot cut frames {}:{} out of a take of {} frames", first, last,
                                 clip.frames()));
  return {clip.samples.middleRows(first, last - first), clip.columns, clip.frame_rate, clip.unit};
}

}  // namespace moclean
