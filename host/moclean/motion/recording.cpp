#include "moclean/motion/recording.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/motion/framed_source.hpp"

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

// The joint that begins with a column, if that is its x and others follow in this order.
Joint joint_at(const std::vector<std::string>& columns, std::size_t first) {
  const ChannelName x = split(columns[first]);
  Index count = 0;
  for (std::size_t i = 0; i < axes.size() && first + i < columns.size(); ++i, ++count) {
    const ChannelName own = split(columns[first + i]);
    if (own.axis != static_cast<char>('x' + static_cast<char>(i)) || own.joint != x.joint ||
        own.separator != x.separator || own.axis_first != x.axis_first)
      break;
  }
  if (count < 2) return {columns[first], static_cast<Index>(first), 1};
  return {std::string(x.joint), static_cast<Index>(first), count};
}

// Some frames, with all that is known of them.
template <class Rows>
Recording rows_of(const Recording& recording, const Rows& rows) {
  Recording part = like(recording, recording.samples(rows, Eigen::all));
  part.skeleton = recording.skeleton;
  if (recording.confidence.size() > 0) part.confidence = recording.confidence(rows, Eigen::all);
  if (recording.channels.size() > 0) part.channels = recording.channels(rows, Eigen::all);
  part.source = recording.source;
  part.notes = recording.notes;
  return part;
}

}  // namespace

std::vector<Joint> joints(const Recording& recording) {
  std::vector<Joint> found;
  for (std::size_t column = 0; column < recording.columns.size();) {
    found.push_back(joint_at(recording.columns, column));
    column += static_cast<std::size_t>(found.back().columns);
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

Recording excerpt(const Recording& recording, Index first, Index last) {
  if (first < 0 || first >= last || last > recording.frames())
    throw ShapeError(fmt::format("cannot cut frames {}:{} out of a take of {} frames", first, last,
                                 recording.frames()));
  Recording part = rows_of(recording, Eigen::seq(first, last - 1));
  if (auto* source = std::any_cast<FramedSource>(&part.source)) source->first += first;
  return part;
}

Recording thinned(const Recording& recording, Index every) {
  const Index kept = (recording.frames() - 1) / every + 1;
  Recording result = rows_of(recording, Eigen::seqN(0, kept, every));
  result.frame_rate /= static_cast<double>(every);
  if (every > 1 && std::any_cast<FramedSource>(&result.source)) result.source.reset();
  return result;
}

Recording like(const Recording& recording, Matrix samples) {
  return {.samples = std::move(samples),
          .columns = recording.columns,
          .frame_rate = recording.frame_rate,
          .unit = recording.unit,
          .up = recording.up};
}

Recording columns_of(const Recording& recording, const std::vector<Index>& columns) {
  Recording part = like(recording, recording.samples(Eigen::all, columns));
  if (recording.confidence.size() > 0) part.confidence = recording.confidence(Eigen::all, columns);
  part.columns.clear();
  for (const Index c : columns)
    part.columns.push_back(recording.columns[static_cast<std::size_t>(c)]);
  return part;
}

Recording joint_positions(SkeletonMotion motion) {
  Recording recording{.samples = forward_kinematics(motion.skeleton, motion.channels),
                      .columns = {},
                      .frame_rate = motion.frame_rate,
                      .unit = std::move(motion.unit)};
  for (const Bone& bone : motion.skeleton.bones)
    for (const std::string_view axis : axes)
      recording.columns.push_back(bone.name + std::string(axis));
  recording.skeleton = std::move(motion.skeleton);
  recording.channels = std::move(motion.channels);
  recording.source = std::move(motion.source);
  recording.notes.warnings = std::move(motion.warnings);
  return recording;
}

std::vector<int> joint_parents(const Skeleton& skeleton, const Recording& recording) {
  const bool are_same = std::ranges::equal(joints(recording), skeleton.bones,
                                           [](const Joint& joint, const Bone& bone) {
                                             return joint.columns == 3 && joint.name == bone.name;
                                           });
  std::vector<int> parents;
  if (!are_same) return parents;
  for (const Bone& bone : skeleton.bones) parents.push_back(bone.parent);
  return parents;
}

std::vector<int> joint_parents(const Recording& recording) {
  if (!recording.skeleton) return {};
  return joint_parents(*recording.skeleton, recording);
}

}  // namespace moclean
