#include <algorithm>
#include <any>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/bvh.hpp"
#include "moclean/formats/formats.hpp"
#include "moclean/formats/frame_rate.hpp"
#include "moclean/formats/plain_number.hpp"
#include "moclean/formats/written_text.hpp"
#include "moclean/motion/inverse_kinematics.hpp"

namespace moclean {
namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;

bool is_bvh_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

// The numbers of a text one after the other, and what stands between them.
class NumberWalk {
 public:
  explicit NumberWalk(std::string_view text) : rest_(text) {}

  // What stands before the next number; the number is then that of text().
  std::string_view gap() {
    const auto first = std::ranges::find_if_not(rest_, is_bvh_space);
    const std::string_view gap(rest_.begin(), first);
    text_ = {first, std::find_if(first, rest_.end(), is_bvh_space)};
    rest_ = {text_.end(), rest_.end()};
    return gap;
  }

  std::string_view text() const { return text_; }
  std::string_view rest() const { return rest_; }

  double value() const {
    const bool has_plus = text_.starts_with('+');
    const char *const first = text_.data() + has_plus, *const last = text_.data() + text_.size();
    double value = 0;
    if (plain_number(first, last, value) != last) std::from_chars(first, last, value);
    return value;
  }

 private:
  std::string_view rest_, text_;
};

// As many decimals as the first numbers of the file have, and no fewer than keep angles and places
// of a body to 1e-5 of its size.
int decimals_in(std::string_view rows) {
  constexpr int numbers = 4000;
  std::size_t most = 4;
  NumberWalk walk(rows);
  for (int n = 0; n < numbers; ++n) {
    walk.gap();
    if (walk.text().empty()) break;
    most = std::max(most, decimals_of(walk.text()).value_or(0));
  }
  return static_cast<int>(std::min<std::size_t>(most, 12));
}

class BvhWriter {
 public:
  BvhWriter(AtomicFile& file, const BvhDocument& document, const Recording& recording)
      : file_(file), document_(document), recording_(recording) {
    for (const Bone& bone : recording.skeleton->bones)
      for (const Channel channel : bone.channels)
        scales_.push_back(is_translation(channel) ? 1 : radians_per_degree);
  }

  void write(const Matrix& channels) {
    const std::string_view motion = document_.motion;
    const std::string_view rows = motion.substr(document_.rows);
    decimals_ = decimals_in(rows);
    text_ = document_.hierarchy;
    head(motion.substr(0, document_.rows));
    if (document_.frames == recording_.frames())
      rewrite(rows, channels);
    else
      write_anew(channels);
    file_.write(text_);
  }

 private:
  // From MOTION up to the frame time, with the number of frames there are, and another time if the
  // rate is another one.
  void head(std::string_view head) {
    const auto put = [&](std::string_view keyword, const std::string& value, bool is_same) {
      const auto found = std::search(head.begin(), head.end(), keyword.begin(), keyword.end(),
                                     [](char a, char b) { return (a | 0x20) == (b | 0x20); });
      const auto end = found == head.end() ? found : found + static_cast<Index>(keyword.size());
      text_.append(head.begin(), end);
      NumberWalk walk({end, head.end()});
      text_ += walk.gap();
      text_ += is_same ? walk.text() : std::string_view(value);
      head = walk.rest();
    };
    const double rate = rate_from_period(document_.frame_time);
    put("Frames:", fmt::to_string(recording_.frames()),
        recording_.frames() == document_.stated_frames);
    put("Time:", fmt::format("{:.8g}", 1 / recording_.frame_rate), recording_.frame_rate == rate);
    text_ += head;
  }

  // The rows of the file, in which numbers that have changed are replaced.
  void rewrite(std::string_view rows, const Matrix& channels) {
    NumberWalk walk(rows);
    for (Index f = -document_.first_frame; f < channels.rows(); ++f) {
      for (std::size_t c = 0; c < scales_.size(); ++c) {
        const std::string_view gap = walk.gap();
        if (f < 0) continue;
        if (f > 0 || c > 0) text_ += gap;
        const double value = channels(f, static_cast<Index>(c));
        if (walk.value() * scales_[c] == value)
          text_ += walk.text();
        else
          put_number(value / scales_[c]);
      }
      write_if_full(file_, text_);
    }
    const std::string_view rest = walk.rest();
    const bool is_all = document_.first_frame + document_.frames == document_.all_frames;
    text_ += is_all ? rest : rest.substr(0, std::min(rest.find('\n'), rest.size() - 1) + 1);
  }

  void write_anew(const Matrix& channels) {
    for (const auto& frame : channels.rowwise()) {
      for (std::size_t c = 0; c < scales_.size(); ++c) {
        if (c > 0) text_ += ' ';
        put_number(frame[static_cast<Index>(c)] / scales_[c]);
      }
      text_ += '\n';
      write_if_full(file_, text_);
    }
  }

  void put_number(double value) {
    if (std::abs(value) < 0.5 * std::pow(10., -decimals_)) value = 0;  // not -0.0000
    std::array<char, 400> digits;  // 1.8e308 has 309 before the point
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                   std::chars_format::fixed, decimals_);
    text_.append(digits.data(), end.ptr);
  }

  AtomicFile& file_;
  const BvhDocument& document_;
  const Recording& recording_;
  std::vector<double> scales_;  // what a number of the file is multiplied with
  int decimals_ = 0;
  std::string text_;
};

[[noreturn]] void fail_without_skeleton(const AtomicFile& file) {
  throw FileError(file.target(),
                  "cannot be written: BVH holds rotations of a skeleton, and only a recording read "
                  "from a BVH file has both; positions go into " +
                      any_extension(holds_any_samples));
}

}  // namespace

void write_bvh(AtomicFile& file, const Recording& recording) {
  const auto* const document = std::any_cast<BvhDocument>(&recording.source);
  if (!document || !recording.skeleton || joint_parents(recording).empty() ||
      recording.channels.rows() != recording.frames() ||
      recording.channels.cols() != recording.skeleton->channels())
    fail_without_skeleton(file);
  const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const Matrix channels =
      inverse_kinematics(*recording.skeleton, recording.channels, recording.samples, threads);
  BvhWriter(file, *document, recording).write(channels);
}

}  // namespace moclean
