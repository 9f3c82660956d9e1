#include <algorithm>
#include <any>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/bvh.hpp"
#include "moclean/formats/channel_text.hpp"
#include "moclean/formats/formats.hpp"
#include "moclean/formats/frame_rate.hpp"
#include "moclean/motion/framed_source.hpp"
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

 private:
  std::string_view rest_, text_;
};

// That of the file's first numbers.
ChannelSpelling spelling_of(std::string_view rows) {
  constexpr int numbers = 4000;
  ChannelSpelling spelling;
  NumberWalk walk(rows);
  for (int n = 0; n < numbers; ++n) {
    walk.gap();
    if (walk.text().empty()) break;
    spelling.learn(walk.text());
  }
  return spelling;
}

// A recording of a BVH file, as such a file again.
class BvhWriter {
 public:
  BvhWriter(AtomicFile& file, const BvhDocument& document, Index first, const Recording& recording)
      : file_(file), document_(document), first_(first), recording_(recording) {
    for (const Bone& bone : recording.skeleton->bones)
      for (const Channel channel : bone.channels)
        scales_.push_back(is_translation(channel) ? 1 : radians_per_degree);
  }

  void write(const Matrix& channels) {
    const std::string_view text = document_.text;
    const std::string_view rows = text.substr(document_.rows, document_.end - document_.rows);
    spelling_ = spelling_of(rows);
    head();
    rewrite(rows, channels);
    file_.write(text_);
  }

 private:
  // Up to the first frame, with the number of frames there are, and another time if the rate is
  // another one.
  void head() {
    const std::string_view text = document_.text;
    std::size_t done = 0;
    const auto put = [&](const BvhDocument::Word& word, const std::string& value) {
      text_ += text.substr(done, word.first - done);
      text_ += value;
      done = word.first + word.size;
    };
    const double stated = document_.frame_time > 0 ? rate_from_period(document_.frame_time) : 0;
    const bool is_new = recording_.frame_rate > 0 && recording_.frame_rate != stated;
    std::string time = is_new ? fmt::format("{:.8g}", 1 / recording_.frame_rate) : "";
    if (spelling_.has_comma) std::replace(time.begin(), time.end(), '.', ',');
    const bool has_time = document_.time_word.size > 0;
    const bool time_first = has_time && document_.time_word.first < document_.frames_word.first;
    if (is_new && time_first) put(document_.time_word, time);
    if (recording_.frames() != document_.stated_frames)
      put(document_.frames_word, fmt::to_string(recording_.frames()));
    if (is_new && has_time && !time_first) put(document_.time_word, time);
    text_ += text.substr(done, document_.rows - done);
    if (is_new && !has_time) text_ += "Frame Time: " + time + '\n';
  }

  // The rows of the file, in which numbers that have changed are replaced.
  void rewrite(std::string_view rows, const Matrix& channels) {
    NumberWalk walk(rows);
    for (Index f = -first_; f < channels.rows(); ++f) {
      for (std::size_t c = 0; c < scales_.size(); ++c) {
        const std::string_view gap = walk.gap();
        if (f < 0) continue;
        if (f > 0 || c > 0) text_ += gap;
        const double value = channels(f, static_cast<Index>(c));
        if (std::isnan(value) || channel_number(walk.text()) * scales_[c] == value)
          text_ += walk.text();
        else
          spelling_.put(value / scales_[c], text_);
      }
      write_if_full(file_, text_);
    }
    const std::string_view rest = walk.rest();
    const bool is_all = first_ + recording_.frames() == document_.frames;
    text_ += is_all ? rest : rest.substr(0, std::min(rest.find('\n'), rest.size() - 1) + 1);
  }

  AtomicFile& file_;
  const BvhDocument& document_;
  Index first_;  // frame of the document, that is frame 0 of the recording
  const Recording& recording_;
  std::vector<double> scales_;  // what a number of the file is multiplied with
  ChannelSpelling spelling_;
  std::string text_;
};

[[noreturn]] void fail_without_skeleton(const AtomicFile& file) {
  throw FileError(file.target(),
                  "cannot be written: BVH holds rotations of a skeleton, and only a recording read "
                  "from a " +
                      any_extension(has_skeleton) + " file has both; positions go into " +
                      any_extension(holds_any_samples));
}

}  // namespace

void write_bvh(AtomicFile& file, const Recording& recording) {
  if (!recording.skeleton || joint_parents(recording).empty() ||
      recording.channels.rows() != recording.frames() ||
      recording.channels.cols() != recording.skeleton->channels())
    fail_without_skeleton(file);
  const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const Matrix channels =
      inverse_kinematics(*recording.skeleton, recording.channels, recording.samples, threads);
  const auto* const source = std::any_cast<FramedSource>(&recording.source);
  const auto* const document =
      source ? std::any_cast<std::shared_ptr<const BvhDocument>>(&source->file) : nullptr;
  if (document && source->first + recording.frames() <= (*document)->frames)
    BvhWriter(file, **document, source->first, recording).write(channels);
  else
    write_new_bvh(file, recording, channels);
}

}  // namespace moclean
