#include <algorithm>
#include <any>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/text_scanner.hpp"
#include "moclean/formats/trc.hpp"
#include "moclean/formats/trc_text.hpp"
#include "moclean/formats/written_text.hpp"
#include "moclean/motion/unit.hpp"

namespace moclean {
namespace {

bool is_same_sample(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

// Writes a recording into the text it was read from.
class TrcRewriter {
 public:
  TrcRewriter(AtomicFile& file, const TrcDocument& document, const Matrix& samples)
      : file_(file), document_(document), samples_(samples), decimals_(least_decimals()) {
    count_decimals();
  }

  void write() {
    head();
    TextLines lines(document_.text, document_.rows, document_.first_line);
    Index frame = -document_.first_frame;
    while (lines.next()) {
      const bool is_row = !is_trc_blank(lines.line());
      if (is_row && frame == document_.frames) break;
      const bool is_wanted = is_row ? frame >= 0 : frame > 0;
      if (is_row && is_wanted) row(lines.line(), samples_.row(frame));
      const std::size_t rest = lines.begin() + (is_row ? lines.line().size() : 0);
      if (is_wanted)
        text_ += std::string_view(document_.text).substr(rest, lines.position() - rest);
      frame += is_row;
      write_if_full(file_, text_);
    }
    file_.write(text_);
  }

 private:
  int least_decimals() const { return document_.unit == "m" ? 6 : 4; }

  // As many as a sample of the first rows with samples has.
  void count_decimals() {
    std::size_t looked_at = 0;
    for (TextLines lines(document_.text, document_.rows); looked_at < 1000 && lines.next();) {
      Index column = -2;
      for (TrcCells cells(lines.line()); cells.next() && column < samples_.cols(); ++column) {
        const auto count = decimals_of(cells.cell());
        if (column < 0 || !count) continue;
        decimals_ = std::max(decimals_, static_cast<int>(std::min<std::size_t>(*count, 15)));
        ++looked_at;
      }
    }
  }

  // All lines above the rows, with the number of frames that there are.
  void head() {
    const std::string_view head = std::string_view(document_.text).substr(0, document_.rows);
    std::string_view count = head.substr(head.size());
    std::vector<std::string_view> names;
    int line = 0;  // that are not blank
    for (TextLines lines(head); lines.next();) {
      if (is_trc_blank(lines.line())) continue;
      ++line;
      if (line == 2) names = trc_cells(lines.line());
      if (line != 3) continue;
      const std::vector<std::string_view> values = trc_settings(lines.line(), names.size());
      for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i)
        if (names[i] == "NumFrames") count = values[i];
    }
    const auto place = static_cast<std::size_t>(count.data() - head.data());
    const std::size_t length = count.size();
    text_ = head.substr(0, place);
    if (place < head.size()) text_ += fmt::to_string(document_.frames);
    text_ += head.substr(place + length);
  }

  void row(std::string_view line, const Eigen::Ref<const Eigen::RowVectorXd>& samples) {
    TrcCells cells(line);
    const char* copied = line.data();
    Index column = -2;  // Frame# and Time come first
    for (; column < samples.size() && cells.next(); ++column) {
      if (column < 0) continue;
      double value = 0;
      trc_sample(cells.cell(), value);
      if (is_same_sample(value, samples[column])) continue;
      text_.append(copied, cells.cell().data());
      put(samples[column], cells.has_tabs());
      copied = cells.cell().data() + cells.cell().size();
    }
    text_.append(copied, line.data() + line.size());
    for (; column < samples.size(); ++column) {
      text_ += cells.separator();
      if (column >= 0) put(samples[column], true);
    }
  }

  void put(double value, bool has_tabs) {
    if (!std::isnan(value))
      fmt::format_to(std::back_inserter(text_), "{:.{}f}", value, decimals_);
    else if (!has_tabs)
      text_ += "nan";
  }

  AtomicFile& file_;
  const TrcDocument& document_;
  const Matrix& samples_;
  int decimals_;
  std::string text_;
};

// The names of the markers; throws for columns that are none.
std::vector<std::string> markers_of(const AtomicFile& file, const Recording& recording) {
  std::vector<std::string> names;
  for (const Joint& joint : joints(recording)) {
    if (joint.columns != 3)
      throw FileError(file.target(), fmt::format("cannot be written: a TRC file holds markers, and "
                                                 "column {} is no x, y, z of one",
                                                 excerpt(joint.name)));
    if (joint.name.find_first_of("\t\r\n") != std::string::npos)
      throw FileError(file.target(), "cannot be written: the name " + excerpt(joint.name) +
                                         " holds a tab or a line break");
    names.push_back(joint.name);
  }
  return names;
}

std::string new_head(const AtomicFile& file, const Recording& recording, const std::string& unit) {
  const std::vector<std::string> names = markers_of(file, recording);
  const Index frames = recording.frames();
  const double rate = recording.frame_rate;
  std::string text = fmt::format(
      "PathFileType\t4\t(X/Y/Z)\t{}\n"
      "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
      "OrigNumFrames\n"
      "{}\t{}\t{}\t{}\t{}\t{}\t1\t{}\n"
      "Frame#\tTime",
      file.target().filename().string(), rate, rate, frames, names.size(), unit, rate, frames);
  for (const std::string& name : names) text += "\t" + name + "\t\t";
  text += "\n\t";
  for (std::size_t m = 1; m <= names.size(); ++m) text += fmt::format("\tX{0}\tY{0}\tZ{0}", m);
  return text + "\n\n";
}

void write_anew(AtomicFile& file, const Recording& recording) {
  if (!(recording.frame_rate > 0))
    throw FileError(file.target(),
                    "cannot be written: a TRC file needs a frame rate (--rate states it)");
  const bool is_scaled = recording.unit == "ASF units";
  const double scale = is_scaled ? *millimetres(recording.unit) : 1;
  const std::string unit = is_scaled ? "mm" : (recording.unit.empty() ? "unknown" : recording.unit);
  std::string text = new_head(file, recording, unit);
  std::array<char, 32> number{};
  for (Index f = 0; f < recording.frames(); ++f) {
    fmt::format_to(std::back_inserter(text), "{}\t{:.6f}", f + 1,
                   static_cast<double>(f) / recording.frame_rate);
    for (const double sample : recording.samples.row(f)) {
      text += '\t';
      if (std::isnan(sample)) continue;
      char* const end =
          std::to_chars(number.data(), number.data() + number.size(), scale * sample).ptr;
      text.append(number.data(), end);
    }
    text += '\n';
    write_if_full(file, text);
  }
  file.write(text);
}

bool is_of(const TrcDocument& document, const Recording& recording) {
  return document.frames == recording.frames() && document.columns == recording.columns &&
         document.frame_rate == recording.frame_rate && document.unit == recording.unit;
}

}  // namespace

void write_trc(AtomicFile& file, const Recording& recording) {
  const auto* const document = std::any_cast<TrcDocument>(&recording.source);
  if (document && is_of(*document, recording))
    TrcRewriter(file, *document, recording.samples).write();
  else
    write_anew(file, recording);
}

}  // namespace moclean
