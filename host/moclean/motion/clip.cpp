#include "moclean/motion/clip.hpp"

#include <array>
#include <cctype>
#include <string_view>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

constexpr std::array<std::string_view, 3> axes = {".x", ".y", ".z"};
constexpr std::string_view separators = "._- :";

// A column's name taken apart.
struct ChannelName {
  std::string_view joint;
  std::string_view separator;
  char axis = 0;  // x, y or z; 0 if the name tells of none
  bool axis_first = false;
};

char axis_of(char letter) {
  const auto small = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return small >= 'x' && small <= 'z' ? small : char{0};
}

ChannelName split(std::string_view name) {
  if (name.size() < 3) return {};
  const auto separates = [](char c) { return separators.find(c) != std::string_view::npos; };
  const std::size_t last = name.size() - 1;
  if (axis_of(name[last]) && separates(name[last - 1]))
    return {name.substr(0, last - 1), name.substr(last - 1, 1), axis_of(name[last]), false};
  if (axis_of(name[0]) && separates(name[1]))
    return {name.substr(2), name.substr(1, 1), axis_of(name[0]), true};
  return {};
}

// The joint of the three columns from `first` on, if they are its x, y and z, in this order; else
// empty.
std::string_view joint_name(const std::vector<std::string>& columns, std::size_t first) {
  if (first + axes.size() > columns.size()) return {};
  const ChannelName x = split(columns[first]);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const ChannelName own = split(columns[first + i]);
    if (own.axis != static_cast<char>('x' + static_cast<char>(i)) || own.joint != x.joint ||
        own.separator != x.separator || own.axis_first != x.axis_first)
      return {};
  }
  return x.joint;
}

}  // namespace

std::vector<Joint> joints(const Clip& clip) {
  std::vector<Joint> found;
  for (std::size_t column = 0; column < clip.columns.size();) {
    const std::string_view name = joint_name(clip.columns, column);
    const Index width = name.empty() ? 1 : 3;
    found.push_back({name.empty() ? clip.columns[column] : std::string(name),
                     static_cast<Index>(column), width});
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
