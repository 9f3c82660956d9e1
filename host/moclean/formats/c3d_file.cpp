#include "moclean/formats/c3d_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/large_memory.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;

// Words of the header, by their byte (c3d.org, "The header section").
constexpr std::size_t points_at = 2, analog_at = 4, first_at = 6, last_at = 8, scale_at = 12,
                      data_block_at = 16, rate_at = 20;

constexpr char c3d_key = 0x50;
constexpr double most_frames = 1e12;

C3dNumbers numbers_of(std::string_view bytes, std::size_t parameter_start, const fs::path& file) {
  const unsigned processor = static_cast<unsigned char>(bytes[parameter_start + 3]);
  if (processor < 84 || processor > 86)
    throw FileError(file, fmt::format("byte {}: expected the processor of a C3D file, 84 (Intel), "
                                      "85 (DEC) or 86 (MIPS), found {}",
                                      parameter_start + 3, processor));
  return C3dNumbers(static_cast<C3dProcessor>(processor));
}

std::size_t parameter_start_of(std::string_view bytes, const fs::path& file) {
  if (bytes.size() < c3d_block)
    throw FileError(file, fmt::format("expected a C3D file, which begins with a header of {} "
                                      "bytes, found {} bytes",
                                      c3d_block, bytes.size()));
  if (bytes[1] != c3d_key)
    throw FileError(file, fmt::format("byte 1: expected 80, as in every C3D file, found {}",
                                      static_cast<unsigned char>(bytes[1])));
  const std::size_t block = static_cast<unsigned char>(bytes[0]);
  if (block < 2 || block * c3d_block > bytes.size())
    throw FileError(file, fmt::format("byte 0: expected the block in which the C3D parameters "
                                      "begin, 2 to {}, found {}",
                                      bytes.size() / c3d_block, block));
  return (block - 1) * c3d_block;
}

// What each of the places says, most trusted first; 0: nothing.
struct FrameCount {
  std::string_view place;
  double frames = 0;
};

double field(const std::vector<unsigned>& words) {
  const double high = words.size() > 1 ? words[1] : 0;
  return words.empty() ? 0 : words[0] + 65536 * high;
}

// A 16-bit one has no sign, whatever the type says.
double count_in(const C3dParameters& parameters, std::string_view name) {
  if (const auto words = parameters.words("POINT", name); !words.empty()) return words[0];
  const auto values = parameters.numbers("POINT", name);
  return values.empty() ? 0 : values[0];
}

std::vector<FrameCount> frame_counts(const C3dFile& c3d) {
  const C3dParameters& all = c3d.parameters;
  const C3dNumbers& numbers = c3d.layout.numbers;
  const auto start = all.words("TRIAL", "ACTUAL_START_FIELD");
  const auto end = all.words("TRIAL", "ACTUAL_END_FIELD");
  const double first = numbers.word(&c3d.bytes[first_at]), last = numbers.word(&c3d.bytes[last_at]);
  return {
      {"TRIAL:ACTUAL_END_FIELD", start.empty() || end.empty() ? 0 : field(end) - field(start) + 1},
      {"POINT:LONG_FRAMES", count_in(all, "LONG_FRAMES")},
      {"POINT:FRAMES", count_in(all, "FRAMES")},
      {"the header", last - first + 1}};
}

// The blocks in which header and POINT:DATA_START say that the data begin, or those behind the
// parameters where neither is possible.
std::size_t data_start_of(const C3dFile& c3d) {
  const C3dLayout& layout = c3d.layout;
  const std::size_t header = layout.numbers.word(&c3d.bytes[data_block_at]);
  const auto stated = c3d.parameters.words("POINT", "DATA_START");
  for (const std::size_t block : {header, stated.empty() ? std::size_t{0} : stated[0]})
    if (block >= 2 && (block - 1) * c3d_block < c3d.bytes.size() &&
        (block - 1) * c3d_block != layout.parameter_start)
      return (block - 1) * c3d_block;
  const auto blocks = static_cast<unsigned char>(c3d.bytes[layout.parameter_start + 2]);
  return std::min(layout.parameter_start + std::max<std::size_t>(blocks, 1) * c3d_block,
                  c3d.bytes.size());
}

Index frames_of(const C3dFile& c3d, const fs::path& file) {
  const std::size_t room = c3d.bytes.size() - c3d.layout.data_start;
  const auto bytes = static_cast<double>(c3d.layout.frame_bytes());
  const auto left = [&](double frames) { return static_cast<double>(room) - frames * bytes; };
  std::vector<FrameCount> counts = frame_counts(c3d);
  std::erase_if(counts, [](const FrameCount& count) {
    return !(count.frames >= 1 && count.frames <= most_frames);
  });
  if (counts.empty()) throw FileError(file, "the C3D file states no number of frames above 0");
  for (const FrameCount& count : counts)
    if (left(count.frames) >= 0 && left(count.frames) < c3d_block)
      return static_cast<Index>(count.frames);
  for (const FrameCount& count : counts)
    if (left(count.frames) >= 0) return static_cast<Index>(count.frames);
  throw FileError(
      file, fmt::format("the C3D data are cut short: expected {:.0f} frames of {} bytes ({}) from "
                        "byte {}, found {} bytes, which are {} whole frames",
                        counts[0].frames, c3d.layout.frame_bytes(), counts[0].place,
                        c3d.layout.data_start, room, room / c3d.layout.frame_bytes()));
}

void read_scale(C3dFile& c3d, const fs::path& file) {
  const auto stated = c3d.parameters.numbers("POINT", "SCALE");
  const double scale = stated.empty() ? c3d.layout.numbers.real(&c3d.bytes[scale_at]) : stated[0];
  if (!std::isfinite(scale) || scale == 0)
    throw FileError(file, fmt::format("expected POINT:SCALE, the unit of integer coordinates or a "
                                      "negative number, found {}",
                                      scale));
  c3d.layout.is_float = scale < 0;
  c3d.layout.scale = std::abs(scale);
}

void read_points(C3dFile& c3d, const fs::path& file) {
  const C3dNumbers& numbers = c3d.layout.numbers;
  const auto used = c3d.parameters.words("POINT", "USED");
  c3d.layout.analog = numbers.word(&c3d.bytes[analog_at]);
  c3d.layout.points = used.empty() ? numbers.word(&c3d.bytes[points_at]) : used[0];
  if (c3d.layout.points == 0)
    throw FileError(file,
                    fmt::format("holds no 3-D points, only {} analog samples per frame: there is "
                                "no motion in it",
                                c3d.layout.analog));
}

std::set<std::string> names_of_results(const C3dParameters& parameters) {
  std::vector<std::string> kinds = {"ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS"};
  const std::vector<std::string> stated = parameters.texts("POINT", "TYPE_GROUPS");
  for (std::size_t i = 0; i < stated.size(); i += 2) kinds.push_back(stated[i]);  // kind, unit
  std::set<std::string> names;
  for (const std::string& kind : kinds)
    for (std::string& name : parameters.texts("POINT", kind)) names.insert(std::move(name));
  names.erase("");
  return names;
}

// Gives every point a name of its own: those without a label are named after their number, those
// with another's label get a number behind it.
class PointNames {
 public:
  explicit PointNames(const std::vector<std::string>& labels)
      : labels_(labels.begin(), labels.end()) {}

  std::string of(const std::string& label, Index number) {
    if (!label.empty() && named_.insert(label).second) return label;
    std::string name = label.empty() ? fmt::format("point{}", number) : label;
    while (label == name || labels_.contains(name) || named_.contains(name))
      name = fmt::format("{}_{}", label.empty() ? "point" : label,
                         ++copies_.try_emplace(label, 1).first->second);
    named_.insert(name);
    return name;
  }

 private:
  std::set<std::string> labels_, named_;
  std::map<std::string, int> copies_;  // per label; starts at 1, the first has none
};

void name_points(C3dFile& c3d, const fs::path& file) {
  const std::vector<std::string> labels = c3d.parameters.texts("POINT", "LABELS");
  const std::set<std::string> results = names_of_results(c3d.parameters);
  PointNames names(labels);
  for (Index p = 0; p < c3d.layout.points; ++p) {
    const auto place = static_cast<std::size_t>(p);
    const std::string label = place < labels.size() ? labels[place] : std::string();
    if (results.contains(label)) continue;
    const std::string name = names.of(label, p + 1);
    c3d.coordinates.push_back(p);
    for (const std::string_view axis : {".x", ".y", ".z"})
      c3d.columns.push_back(fmt::format("{}{}", name, axis));
  }
  if (c3d.coordinates.empty())
    throw FileError(file,
                    "holds no coordinates, only results of a model (POINT:ANGLES, FORCES ...)");
}

// The number of fewest digits that is stored as this real: 59.94, not 59.93999862670898.
double shortest(double real) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.begin(), digits.end(), static_cast<float>(real)).ptr;
  std::from_chars(digits.begin(), end, real);
  return real;
}

}  // namespace

C3dFile parse_c3d_file(std::string_view bytes, const fs::path& file) {
  const std::size_t parameter_start = parameter_start_of(bytes, file);
  const C3dNumbers numbers = numbers_of(bytes, parameter_start, file);
  C3dFile c3d{.bytes = {},
              .layout = {.numbers = numbers, .parameter_start = parameter_start},
              .parameters = C3dParameters(bytes, parameter_start + 4, numbers, file),
              .coordinates = {},
              .columns = {}};
  c3d.bytes.reserve(bytes.size());
  wish_huge_pages(c3d.bytes.data(), bytes.size());
  c3d.bytes = bytes;
  read_scale(c3d, file);
  read_points(c3d, file);
  c3d.layout.data_start = data_start_of(c3d);
  c3d.layout.frames = frames_of(c3d, file);
  const auto start = c3d.parameters.words("TRIAL", "ACTUAL_START_FIELD");
  c3d.layout.first_frame =
      static_cast<Index>(start.empty() ? numbers.word(&bytes[first_at]) : field(start));
  name_points(c3d, file);
  return c3d;
}

double c3d_rate(const C3dFile& c3d) {
  const auto stated = c3d.parameters.numbers("POINT", "RATE");
  const double header = c3d.layout.numbers.real(&c3d.bytes[rate_at]);
  for (const double rate : {stated.empty() ? 0 : stated[0], header})
    if (std::isfinite(rate) && rate > 1e-6) return shortest(rate);
  return 0;
}

std::optional<UpAxis> c3d_up(const C3dFile& c3d) {
  const std::string axis = c3d.parameters.text("POINT", "Y_SCREEN");
  if (axis.size() != 2 || (axis[0] != '+' && axis[0] != '-')) return std::nullopt;
  switch (axis[1]) {
    case 'X':
      return UpAxis::x;
    case 'Y':
      return UpAxis::y;
    case 'Z':
      return UpAxis::z;
    default:
      return std::nullopt;
  }
}

}  // namespace moclean
