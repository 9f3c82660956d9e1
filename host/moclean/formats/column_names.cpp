#include "moclean/formats/column_names.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <unordered_set>

namespace moclean {
namespace {

using Words = std::vector<std::string>;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> known) {
  return std::find(known.begin(), known.end(), word) != known.end();
}

constexpr std::string_view joining = "._- :/";

bool joins(char c) { return joining.find(c) != std::string_view::npos; }

char axis_letter(char c) {
  const auto small = static_cast<char>(c | 0x20);
  return small >= 'w' && small <= 'z' ? small : char{0};
}

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

// What stands before a last pair of brackets and in it.
struct Bracketed {
  std::string_view before, inside;
};

std::optional<Bracketed> bracketed(std::string_view name) {
  if (name.size() < 3 || (name.back() != ')' && name.back() != ']')) return std::nullopt;
  const std::size_t open = name.rfind(name.back() == ')' ? '(' : '[');
  if (open == std::string_view::npos) return std::nullopt;
  return Bracketed{without_blanks(name.substr(0, open)),
                   without_blanks(name.substr(open + 1, name.size() - open - 2))};
}

std::string_view without_unit(std::string_view name) {
  name = without_blanks(name);
  const auto parts = bracketed(name);
  if (parts && is_unit(parts->inside)) return parts->before;
  constexpr std::size_t length = 3;
  if (name.size() <= length) return name;
  const std::string_view rest = name.substr(0, name.size() - length);
  const std::string ending = in_lower_case(name.substr(rest.size()));
  return is_one_of(ending, {"_mm", "_cm", "_px", " mm", " cm"}) ? rest : name;
}

constexpr std::array<std::string_view, 17> place_words = {
    "position",    "positions", "pos", "coordinate", "coordinates", "coord",
    "coords",      "location",  "loc", "3d",         "2d",          "trans",
    "translation", "p3d",       "kp",  "world",      "xyz"};

// `_pos` of `hip_pos`, `.position` of `hip.position`: a last word that only says that it is a
// place.
std::string_view place_remark(std::string_view name) {
  const std::size_t begin = name.find_last_of("._- :/");
  if (begin == std::string_view::npos || begin == 0) return {};
  const std::string word = in_lower_case(name.substr(begin + 1));
  const bool is_known =
      std::find(place_words.begin(), place_words.end(), word) != place_words.end();
  return is_known ? name.substr(begin) : std::string_view();
}

// Words of letters, in lower case: `LHip_posX 2` has `l`, `hip`, `pos`, `x`.
Words words_of(std::string_view name) {
  Words words;
  bool begins = true;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (!is_letter(name[i])) {
      begins = true;
      continue;
    }
    const bool was_lower = i > 0 && is_letter(name[i - 1]) && !is_upper(name[i - 1]);
    if (begins || (is_upper(name[i]) && was_lower)) words.emplace_back();
    words.back() += static_cast<char>(name[i] | 0x20);
    begins = false;
  }
  return words;
}

using WordSet = std::unordered_set<std::string_view>;

bool is_angle_word(const std::string& word) {
  static const WordSet words = {"rot",         "rotation", "rotations", "angle",      "angles",
                                "ang",         "euler",    "quat",      "quaternion", "orient",
                                "orientation", "rpy",      "xrotation", "yrotation",  "zrotation",
                                "roll",        "pitch",    "yaw",       "qw",         "qx",
                                "qy",          "qz"};
  return words.contains(word);
}

bool is_vector_word(const std::string& word) {
  static const WordSet words = {"vel",  "velocity", "acc",   "acce",   "accel",  "acceleration",
                                "gyro", "mag",      "force", "moment", "torque", "power",
                                "grf",  "jerk",     "omega", "angvel"};
  return words.contains(word);
}

constexpr std::array<std::string_view, 14> confidence_words = {
    "likelihood",  "confidence", "conf",      "score", "visibility", "presence", "prob",
    "probability", "vis",        "certainty", "c",     "p",          "v",        "s"};

// Name without blanks, joining characters and unit, in lower case.
std::string squeezed(std::string_view name) {
  std::string text = in_lower_case(without_unit(name));
  std::erase_if(text, [](char c) { return joins(c); });
  return text;
}

}  // namespace

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (is_upper(c)) c = static_cast<char>(c | 0x20);
  return lower;
}

bool is_length_unit(std::string_view word) {
  return is_one_of(in_lower_case(word),
                   {"mm",     "cm",     "dm",          "m",           "um",          "\xC2\xB5m",
                    "in",     "inch",   "inches",      "ft",          "feet",        "px",
                    "pixel",  "pixels", "millimeters", "millimetres", "centimeters", "centimetres",
                    "meters", "metres", "meter",       "metre"});
}

bool is_unit(std::string_view word) {
  return is_length_unit(word) ||
         is_one_of(in_lower_case(word),
                   {"s",  "sec", "secs", "second", "seconds", "ms",      "msec",  "milliseconds",
                    "us", "ns",  "min",  "deg",    "degree",  "degrees", "rad",   "radians",
                    "hz", "n",   "nm",   "mm/s",   "m/s",     "mm/s^2",  "m/s^2", "mm/s/s",
                    "-",  "1",   "%",    "a.u."});
}

std::string unit_of_name(std::string_view name) {
  const auto parts = bracketed(without_blanks(name));
  return parts && is_unit(parts->inside) ? std::string(parts->inside) : std::string();
}

std::vector<AxisName> axis_names(std::string_view full_name) {
  std::string_view name = without_unit(full_name);
  const std::string_view tail = place_remark(name);  // of `hip_x_3d`
  name.remove_suffix(tail.size());
  std::vector<AxisName> found;
  const auto add = [&](NameStyle style, char joint, std::string_view point, char letter) {
    // Of `hip - x` or `hip, x` the point is `hip`.
    const std::size_t begin = std::min(point.find_first_not_of("._- :/,;"), point.size());
    const std::size_t end = point.find_last_not_of("._- :/,;") + 1;
    if (begin < end) point = point.substr(begin, end - begin);
    const std::string_view remark = place_remark(point);  // of `hip_pos_x`
    point.remove_suffix(remark.size());
    found.push_back({style, joint, std::string(point), axis_letter(letter),
                     std::string(remark) + std::string(tail)});
  };
  if (name.empty()) return found;
  const std::size_t size = name.size();
  const char first = name.front(), last = name.back();
  if (size == 1) {
    if (axis_letter(first)) add(NameStyle::bare, 0, "", first);
    return found;
  }
  if (size > 2 && axis_letter(last) && joins(name[size - 2]))
    add(NameStyle::suffix, name[size - 2], name.substr(0, size - 2), last);
  if (const auto parts = bracketed(name)) {
    if (parts->before.size() == 1 && axis_letter(parts->before[0]))
      add(NameStyle::brackets, '(', parts->inside, parts->before[0]);
    if (parts->inside.size() == 1 && axis_letter(parts->inside[0]))
      add(NameStyle::brackets, ')', parts->before, parts->inside[0]);
  }
  if (size > 2 && axis_letter(first) && joins(name[1]))
    add(NameStyle::prefix, name[1], name.substr(2), first);
  if (const std::string lower = in_lower_case(name); lower.ends_with("position") && size > 8) {
    const std::size_t letter = size - 9 - (joins(name[size - 9]) && size > 9 ? 1 : 0);
    if (axis_letter(name[letter]) && (letter == 0 || joins(name[letter - 1])))
      add(NameStyle::position, 0, name.substr(0, letter > 0 ? letter - 1 : 0), name[letter]);
  }
  if (size > 3 && axis_letter(last) && (name[size - 2] | 0x20) == 't' && joins(name[size - 3]))
    add(NameStyle::shifted, name[size - 3], name.substr(0, size - 3), last);
  if (axis_letter(first) && std::all_of(name.begin() + 1, name.end(), is_digit))
    add(NameStyle::numbered, 0, name.substr(1), first);
  const char before = name[size - 2];
  const bool stands_out =
      is_upper(last) ? is_letter(before) || is_digit(before) : is_upper(before) || is_digit(before);
  if (axis_letter(first) && !is_upper(first) && is_upper(name[1]))
    add(NameStyle::glued, '<', name.substr(1), first);
  if (axis_letter(last) && stands_out) add(NameStyle::glued, 0, name.substr(0, size - 1), last);
  return found;
}

NamedQuantity named_quantity(std::string_view name) {
  const std::string text = squeezed(name);
  static const WordSet times = {"time",        "t",
                                "times",       "timestamp",
                                "timestamps",  "timesec",
                                "timesecs",    "timeseconds",
                                "times",       "timems",
                                "timemsec",    "timemilliseconds",
                                "timeus",      "timens",
                                "tms",         "tsec",
                                "seconds",     "secs",
                                "sec",         "milliseconds",
                                "ms",          "msec",
                                "unixtime",    "unixtimestamp",
                                "epoch",       "epochms",
                                "timestampms", "timestamps",
                                "timestampus", "timestampns",
                                "elapsed",     "elapsedtime",
                                "zeit",        "temps",
                                "tiempo",      "relativetime",
                                "capturetime", "recordingtime",
                                "datetime",    "clock",
                                "clocktime",   "timeofday",
                                "localtime",   "timelocal",
                                "utc",         "utctime",
                                "timeutc",     "timestamputc",
                                "systemtime",  "isotime"};
  if (times.contains(text)) return NamedQuantity::time;
  static const WordSet frames = {"frame",       "frames",     "frameindex", "frameidx", "frameid",
                                 "framenumber", "framenum",   "frameno",    "frame#",   "framenr",
                                 "fnum",        "framecount", "fno"};
  if (frames.contains(text)) return NamedQuantity::frame;
  static const WordSet running = {"index", "idx",   "id",    "i",       "n",       "no",
                                  "nr",    "#",     "item",  "sample",  "samples", "samplenumber",
                                  "row",   "rowid", "count", "counter", "level0"};
  if (text.empty() || text.starts_with("unnamed") || running.contains(text))
    return NamedQuantity::running;
  const Words words = words_of(without_unit(name));
  if (words.empty()) return NamedQuantity::none;
  if (words.back().size() > 2 && std::find(confidence_words.begin(), confidence_words.end(),
                                           words.back()) != confidence_words.end())
    return NamedQuantity::confidence;
  if (std::any_of(words.begin(), words.end(), is_angle_word)) return NamedQuantity::angle;
  if (std::any_of(words.begin(), words.end(), is_vector_word)) return NamedQuantity::rate_of_change;
  return NamedQuantity::none;
}

NamedQuantity quantity_of_letter(std::string_view point) {
  if (point.empty() || (point.size() > 1 && is_letter(point[point.size() - 2])))
    return NamedQuantity::none;
  const auto letter = static_cast<char>(point.back() | 0x20);
  if (letter == 'f' || letter == 'm') return NamedQuantity::rate_of_change;
  const bool is_angle = letter == 'r' || letter == 'o' || letter == 'q';
  return is_angle ? NamedQuantity::angle : NamedQuantity::none;
}

double seconds_per_unit(std::string_view name) {
  std::string unit = in_lower_case(unit_of_name(name));
  if (unit.empty()) {
    const std::string text = squeezed(name);
    for (const std::string_view ending : {"milliseconds", "msec", "ms", "us", "ns"})
      if (unit.empty() && text.ends_with(ending) && text != "times") unit = ending;
    for (const std::string_view ending : {"seconds", "secs", "sec"})
      if (unit.empty() && text.ends_with(ending)) unit = "s";
    if (unit.empty() && in_lower_case(name).ends_with("_s")) unit = "s";
  }
  if (is_one_of(unit, {"ms", "msec", "milliseconds"})) return 1e-3;
  if (unit == "us") return 1e-6;
  if (unit == "ns") return 1e-9;
  if (unit == "min") return 60;
  return is_one_of(unit, {"s", "sec", "secs", "second", "seconds"}) ? 1 : 0;
}

std::vector<std::string> points_judged_by(std::string_view full_name) {
  const std::string name = in_lower_case(full_name);
  std::vector<std::string> found;
  for (const std::string_view word : confidence_words) {
    if (name == word) found.emplace_back();
    if (name.size() <= word.size()) continue;
    const auto behind = name.begin() + static_cast<std::ptrdiff_t>(word.size());
    if (name.starts_with(word) && std::all_of(behind, name.end(), is_digit))
      found.push_back(name.substr(word.size()));
    const std::size_t rest = name.size() - word.size();
    if (name.ends_with(word)) {
      if (joins(name[rest - 1]))
        found.push_back(name.substr(0, rest - 1));
      else if (word.size() > 2)
        found.push_back(name.substr(0, rest));
    }
    if (name.starts_with(word) && joins(name[word.size()]))
      found.push_back(name.substr(word.size() + 1));
  }
  return found;
}

}  // namespace moclean
