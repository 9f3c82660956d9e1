#include "moclean/formats/npz.hpp"

#include <algorithm>
#include <any>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/text_encoding.hpp"
#include "moclean/formats/text_scanner.hpp"
#include "moclean/formats/zip_archive.hpp"
#include "moclean/motion/framed_source.hpp"

namespace moclean {
namespace {

constexpr std::string_view suffix = ".npy";

// Names of members as programs of the field give them, the likeliest first.
constexpr std::array<std::string_view, 16> position_names = {
    "positions", "joints",      "markers",      "points",         "keypoints", "keypoints_3d",
    "joints3d",  "joints_3d",   "positions_3d", "keypoints3d",    "xyz",       "coordinates",
    "samples",   "markers_obs", "poses_3d",     "joint_positions"};
constexpr std::array<std::string_view, 7> rate_names = {
    "fps", "mocap_framerate", "mocap_frame_rate", "frame_rate", "framerate", "rate", "frequency"};
constexpr std::array<std::string_view, 6> label_names = {
    "names", "joint_names", "labels", "marker_names", "columns", "joints_names"};
constexpr std::array<std::string_view, 2> unit_names = {"unit", "units"};
constexpr std::array<std::string_view, 4> rotation_names = {"poses", "pose_body", "root_orient",
                                                            "full_pose"};

template <class Names>
bool names_any(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

class NpzReader {
 public:
  NpzReader(std::string_view content, const std::filesystem::path& file)
      : file_(file), archive_(content, file) {
    for (const std::string& member : archive_.names())
      if (member.size() > suffix.size() && member.ends_with(suffix))
        names_.push_back(member.substr(0, member.size() - suffix.size()));
    if (names_.empty()) throw FileError(file, "holds no array (a member ending in .npy)");
  }

  Recording read(std::string_view content, const ReadOptions& options) {
    const std::string name = positions();
    const std::string data = archive_.member(name + std::string(suffix));
    Recording recording = recording_of(numbers(name, data), file_, options);
    auto& source = std::any_cast<FramedSource&>(recording.source);
    source.file = NpzDocument{.content = std::make_shared<const std::string>(content),
                              .member = name + std::string(suffix),
                              .array = std::any_cast<NpyDocument&&>(std::move(source.file))};
    source.bytes += content.size();
    recording.notes.layout = fmt::format("{}; member {}", recording.notes.layout, name);
    give_names(recording);
    if (const auto rate = number_of(rate_names)) recording.frame_rate = *rate;
    if (const auto unit = texts_among(unit_names); unit.size() == 1) recording.unit = unit[0];
    return recording;
  }

 private:
  // The array of a member that holds numbers.
  NpyArray numbers(const std::string& name, const std::string& data) const {
    NpyArray array = parse_npy_array(data, file_ / name);
    if (!array.type.is_number())
      throw FileError(file_, fmt::format("its member {} holds text", excerpt(name)));
    return array;
  }

  std::string positions() const {
    for (const std::string_view known : position_names)
      if (names_any(names_, known)) return std::string(known);
    for (const std::string_view rotation : rotation_names)
      if (names_any(names_, rotation))
        throw FileError(file_, fmt::format("holds rotations of joints ({}, as AMASS has), no "
                                           "positions; save the joints that the body model makes "
                                           "of them as `joints` (frames, joints, 3)",
                                           rotation));
    for (const std::size_t axes : {3U, 2U}) {
      std::vector<std::string> found;
      for (const std::string& name : names_)
        if (axes_of(name) == axes) found.push_back(name);
      if (found.size() == 1) return found.front();
      if (found.size() > 1)
        throw FileError(file_, fmt::format("several of its arrays may be the positions: {}; call "
                                           "the right one `positions`",
                                           listed(found)));
    }
    throw FileError(file_,
                    fmt::format("expected an array of positions (frames, points, 3), found {}",
                                listed(names_)));
  }

  std::string listed(std::vector<std::string> names) const {
    constexpr std::size_t shown = 8;
    const bool is_all = names.size() <= shown;
    names.resize(std::min(names.size(), shown));
    for (std::string& name : names) name = excerpt(name);
    return fmt::format("{}{}", fmt::join(names, ", "), is_all ? "" : ", ...");
  }

  // Of an array of numbers; 0 for all else.
  std::size_t axes_of(const std::string& name) const {
    const std::string data = archive_.member(name + std::string(suffix));
    const NpyArray array = look_at_npy(data, file_ / name);
    return array.type.is_number() ? array.shape.size() : 0;
  }

  // What `use` makes of the first member of such a name that it makes something of.
  template <class Names, class Use>
  auto first_of(const Names& names, const Use& use) const {
    decltype(use(NpyArray{})) found{};
    for (const std::string_view name : names) {
      if (found || !names_any(names_, name)) continue;
      const std::string data = archive_.member(std::string(name) + std::string(suffix));
      found = use(look_at_npy(data, file_ / std::string(name)));
    }
    return found;
  }

  template <class Names>
  std::optional<double> number_of(const Names& names) const {
    return first_of(names, [](const NpyArray& array) -> std::optional<double> {
      if (!array.type.is_number() || array.items.empty() || array.count() != 1) return {};
      const double number = numbers_of(array)(0, 0);
      return std::isfinite(number) && number > 0 ? std::optional(number) : std::nullopt;
    });
  }

  template <class Names>
  std::vector<std::string> texts_among(const Names& names) const {
    const auto found =
        first_of(names, [](const NpyArray& array) -> std::optional<std::vector<std::string>> {
          if (!array.type.is_text() || array.items.empty()) return {};
          return texts_of(array);
        });
    return found.value_or(std::vector<std::string>{});
  }

  // One per point, or one per column.
  void give_names(Recording& recording) const {
    const std::vector<std::string> names = texts_among(label_names);
    if (names.empty()) return;
    const std::vector<Joint> points = joints(recording);
    std::vector<std::string> columns;
    if (names.size() == recording.columns.size()) {
      columns = names;
    } else if (names.size() == points.size()) {
      for (std::size_t p = 0; p < points.size(); ++p)
        for (Index a = 0; a < points[p].columns; ++a)
          columns.push_back(points[p].columns == 1 ? names[p]
                                                   : names[p] + '.' + "xyz"[static_cast<int>(a)]);
    } else {
      recording.notes.warnings.push_back(fmt::format(
          "has {} names for {} points: they are not used", names.size(), points.size()));
      return;
    }
    recording.columns = columns;
    std::any_cast<NpzDocument&>(std::any_cast<FramedSource&>(recording.source).file).array.columns =
        std::move(columns);
  }

  std::filesystem::path file_;
  ZipArchive archive_;
  std::vector<std::string> names_;  // of arrays, without .npy
};

// An array of text, '<U' as NumPy makes it.
std::string text_array(const std::vector<std::string>& texts, bool is_scalar) {
  std::vector<std::vector<std::uint32_t>> codes(texts.size());
  std::size_t longest = 1;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    for (std::size_t place = 0; place < texts[i].size();)
      codes[i].push_back(take_utf8(texts[i], place));
    longest = std::max(longest, codes[i].size());
  }
  std::string data =
      npy_head({.order = '<', .kind = 'U', .size = 4 * longest},
               is_scalar ? std::vector<std::uint64_t>{} : std::vector<std::uint64_t>{texts.size()});
  for (std::vector<std::uint32_t>& text : codes) {
    text.resize(longest, 0);
    for (const std::uint32_t code : text)
      for (int shift = 0; shift < 32; shift += 8) data += static_cast<char>(code >> shift & 0xFFU);
  }
  return data;
}

std::string scalar(double number) {
  constexpr NpyType type{};
  std::string data = npy_head(type, {});
  data.resize(data.size() + type.size);
  put_number(number, type, data.data() + data.size() - type.size);
  return data;
}

std::map<std::string, std::string> new_members(const Recording& recording) {
  const std::vector<Joint> points = joints(recording);
  const bool are_points =
      std::ranges::all_of(points, [](const Joint& point) { return point.columns == 3; });
  std::vector<std::string> names;
  for (const Joint& point : points) names.push_back(point.name);

  Recording shaped = like(recording, recording.samples);
  NpyDocument array{};
  array.array.shape = {static_cast<std::uint64_t>(recording.frames())};
  if (are_points) array.array.shape.push_back(points.size());
  array.array.shape.push_back(are_points ? 3 : recording.columns.size());
  array.columns = recording.columns;
  for (Index c = 0; c < recording.samples.cols(); ++c) array.samples.push_back(c);
  array.confidences.assign(array.samples.size(), -1);
  shaped.source = FramedSource{.file = std::move(array)};

  std::map<std::string, std::string> members;
  members[are_points ? "positions.npy" : "samples.npy"] = npy_text(shaped);
  members["names.npy"] = text_array(are_points ? names : recording.columns, false);
  if (recording.frame_rate > 0) members["fps.npy"] = scalar(recording.frame_rate);
  if (!recording.unit.empty()) members["unit.npy"] = text_array({recording.unit}, true);
  return members;
}

const NpzDocument* npz_document_of(const Recording& recording) {
  const auto* const source = std::any_cast<FramedSource>(&recording.source);
  const auto* const document = source ? std::any_cast<NpzDocument>(&source->file) : nullptr;
  if (!document || document->array.columns != recording.columns) return nullptr;
  const auto frames = static_cast<Index>(document->array.array.shape[0]);
  return source->first + recording.frames() <= frames ? document : nullptr;
}

Recording read_npz(std::string_view content, const std::filesystem::path& file,
                   const ReadOptions& options) {
  return parse_npz(content, file, options);
}

}  // namespace

Recording parse_npz(std::string_view content, const std::filesystem::path& file,
                    const ReadOptions& options) {
  return NpzReader(content, file).read(content, options);
}

void write_npz(AtomicFile& file, const Recording& recording) {
  const NpzDocument* const document = npz_document_of(recording);
  if (!document) {
    file.write(with_members({}, new_members(recording), file.target()));
    return;
  }
  Recording positions = like(recording, recording.samples);
  positions.source = FramedSource{.file = document->array,
                                  .first = std::any_cast<FramedSource>(&recording.source)->first};
  file.write(
      with_members(*document->content, {{document->member, npy_text(positions)}}, file.target()));
}

constinit const Format npz_format = {
    .name = "NPZ",
    .extension = ".npz",
    .notes =
        "arrays of NumPy: `positions`, `joints` or `markers` (frames, points, 3), with `names`, "
        "`fps`, `unit`; all other members are kept",
    .content = {.names = true, .frame_rate = true, .unit = true, .gaps = true},
    .read = read_npz,
    .write = write_npz,
};

}  // namespace moclean
