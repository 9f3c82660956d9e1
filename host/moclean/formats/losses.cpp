#include "moclean/formats/losses.hpp"

#include <fmt/format.h>

#include "moclean/formats/bvh.hpp"
#include "moclean/formats/c3d.hpp"

namespace moclean {
namespace {

// Neither of our own making, as of arrays without any, nor numbers of columns.
bool has_names(const Recording& recording, const Format& from) {
  return from.content.names && recording.columns != default_column_names(recording.samples.cols());
}

}  // namespace

std::vector<std::string> losses(const Recording& recording, const Format& from, const Format& to) {
  std::vector<std::string> lost;
  if (&from == &to) return lost;
  const FormatContent& holds = to.content;
  const auto lose = [&](const std::string& what) {
    lost.push_back(fmt::format("{} does not hold {}", to.name, what));
  };
  if (recording.channels.size() > 0 && !holds.skeleton) lose("rotations and bones, only positions");
  if (has_names(recording, from) && !holds.names) lose("names of joints or columns");
  if (recording.frame_rate > 0 && !holds.frame_rate)
    lose(fmt::format("the frame rate ({:.6g} Hz)", recording.frame_rate));
  if (!recording.unit.empty() && !holds.unit)
    lose(fmt::format("the unit of length ({})", recording.unit));
  if (recording.up && !holds.up) lose("the upward axis");
  if (!holds.gaps && recording.samples.array().isNaN().any()) lose("missing samples");
  if (!recording.notes.passed_through.empty())
    lose(fmt::format("columns that are no samples ({})", recording.notes.passed_through.size()));
  if (&from == &c3d_format) lose("analog samples, events and parameters of C3D");
  if (holds.single_precision && !from.content.single_precision) lose("more than single precision");
  if (&to == &bvh_format && recording.frame_rate == 0)
    lost.push_back("no frame rate is known: BVH states 120 Hz; --rate states another");
  return lost;
}

}  // namespace moclean
