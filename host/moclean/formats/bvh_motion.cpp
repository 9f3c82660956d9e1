#include "moclean/formats/bvh_motion.hpp"

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "moclean/formats/frame_rate.hpp"
#include "moclean/formats/row_collector.hpp"

namespace moclean {
namespace {

// What a number of a frame is multiplied with: degrees become radians.
std::vector<double> bvh_scales(const Skeleton& skeleton) {
  std::vector<double> scales;
  for (const Bone& bone : skeleton.bones)
    for (const Channel channel : bone.channels)
      scales.push_back(is_translation(channel) ? 1 : std::numbers::pi / 180);
  return scales;
}

// The words of the next lines that are not blank, line by line.
class WordsOfLines {
 public:
  explicit WordsOfLines(std::string_view text) : rest_(text) {}

  // 0 at the end of the text; counts no further than just above `most`.
  std::size_t next(std::size_t most) {
    std::size_t words = 0;
    skip(" \t\r\n");
    while (!rest_.empty() && rest_.front() != '\r' && rest_.front() != '\n') {
      if (++words > most) return words;
      rest_.remove_prefix(std::min(rest_.find_first_of(" \t\r\n"), rest_.size()));
      skip(" \t");
    }
    return words;
  }

  // Whether there is a line, and it begins like a number.
  bool begins_number() {
    skip(" \t\r\n");
    return rest_.find_first_of("+-.0123456789") == 0;
  }

 private:
  void skip(std::string_view blanks) {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(blanks), rest_.size()));
  }

  std::string_view rest_;
};

class BvhMotionParser {
 public:
  BvhMotionParser(std::string_view text, TextScanner& scanner, BvhDocument& document,
                  SkeletonMotion& motion)
      : text_(text),
        scanner_(scanner),
        document_(document),
        motion_(motion),
        scales_(bvh_scales(motion.skeleton)) {}

  void parse(double rate) {
    header(rate);
    frame_rate(rate);
    scanner_.at_end();  // to the first frame
    document_.rows = place();
    find_lines_per_frame();
    const std::size_t first_line = scanner_.line();
    frames();
    if (lines_per_frame_ > 1 && document_.frames * lines_per_frame_ == document_.stated_frames)
      fail_width(first_line);
    tell_count();
  }

 private:
  std::size_t place() const { return text_.size() - scanner_.bytes_left(); }

  // Either line may stand first.
  void header(double rate) {
    bool has_frames = false, has_time = false;
    for (bool is_any = true; is_any;) {
      is_any = false;
      if (!has_frames && accept_label("Frames")) {
        stated_frames();
        has_frames = is_any = true;
      } else if (!has_time && (accept_label("FrameTime") || accept_frame_time())) {
        frame_time(rate);
        has_time = is_any = true;
      }
    }
    if (!has_frames) scanner_.fail_expected("Frames:");
    if (!has_time && rate == 0)
      scanner_.fail_expected("Frame Time: (--rate states the rate of a file without)");
  }

  void stated_frames() {
    document_.frames_word = next_word();
    const double frames = scanner_.number();  // some write 6.0
    if (frames < 0 || frames > 1e15 || frames != std::floor(frames))
      scanner_.fail(fmt::format("expected a number of frames, found {}", frames));
    document_.stated_frames = static_cast<Index>(frames);
  }

  void frame_time(double rate) {
    document_.time_word = next_word();
    double seconds = 0;
    if (!scanner_.accept_number(seconds)) scanner_.fail_number();
    const bool is_time = seconds > 0 && std::isfinite(1 / seconds);
    if (is_time) document_.frame_time = seconds;
    if (!is_time && rate == 0)
      scanner_.fail("expected a positive frame time (--rate states the rate of a file without)");
    scanner_.expect_line_end();
  }

  // `Frames:`, `Frames :`, `Frames`.
  bool accept_label(const std::string& name) {
    if (scanner_.accept(name + ":")) return true;
    if (!scanner_.accept(name)) return false;
    scanner_.accept(":");
    return true;
  }

  bool accept_frame_time() {
    if (!scanner_.accept("Frame")) return false;
    if (!accept_label("Time")) scanner_.fail_expected("Time:");
    return true;
  }

  BvhDocument::Word next_word() {
    scanner_.at_end();
    const std::size_t first = place();
    const std::size_t last = std::min(text_.find_first_of(" \t\r\n", first), text_.size());
    return {first, last - first};
  }

  void frame_rate(double rate) {
    const double stated = document_.frame_time > 0 ? rate_from_period(document_.frame_time) : 0;
    motion_.frame_rate = rate > 0 ? rate : stated;
    if (rate > 0 && stated > 0 && std::abs(rate - stated) > 1e-3 * stated)
      motion_.warnings.push_back(
          fmt::format("Frame Time states {:.6g} Hz; the rate that was given, {:.6g} Hz, is used",
                      stated, rate));
  }

  // One, unless the first lines together hold exactly the numbers of a frame.
  void find_lines_per_frame() {
    WordsOfLines lines(text_.substr(place()));
    std::size_t words = 0;
    for (Index count = 1; words < scales_.size(); ++count) {
      const std::size_t own = lines.next(scales_.size());
      if (count == 1) first_width_ = own;
      words += own;
      if (own == 0) return;
      if (words == scales_.size()) lines_per_frame_ = count;
    }
  }

  // Then a frame may be over several lines even if the first one is not.
  bool numbers_fill_stated_frames() {
    if (!fills_stated_) {
      const auto width = static_cast<Index>(scales_.size());
      Index words = 0;
      WordsOfLines lines(text_.substr(document_.rows));
      while (lines.begins_number()) words += static_cast<Index>(lines.next(scales_.size()));
      fills_stated_ = words % width == 0 && words / width == document_.stated_frames;
    }
    return *fills_stated_;
  }

  void frames() {
    RowCollector rows(static_cast<Index>(scales_.size()));
    Index whole = 0;
    document_.end = text_.size();
    while (!scanner_.at_end() && !at_text_behind()) {
      const std::size_t first = place();
      if (!frame(rows.add(scanner_.bytes_left()))) {
        document_.end = first;
        break;
      }
      ++whole;
    }
    if (whole == 0)
      scanner_.fail(document_.stated_frames == 0
                        ? "expected at least one frame, found 'Frames: 0'"
                        : fmt::format("expected {} frames, found none", document_.stated_frames));
    motion_.channels = rows.take();
    motion_.channels.conservativeResize(whole, Eigen::NoChange);
    document_.frames = whole;
  }

  bool at_text_behind() {
    if (read_ < document_.stated_frames) return false;
    double ignored = 0;
    TextScanner ahead = scanner_;
    if (ahead.accept_number(ignored)) return false;
    motion_.warnings.push_back(
        fmt::format("line {} and what follows it is no frame; kept as it is", scanner_.line()));
    return true;
  }

  // False if the text ends in the middle of the frame.
  bool frame(double* values) {
    const std::size_t line = scanner_.line();
    for (std::size_t c = 0; c < scales_.size(); ++c) {
      if (scanner_.at_line_end()) {
        if (breaks_off(c, line)) return false;
        if (lines_per_frame_ == 1 && !numbers_fill_stated_frames()) fail_width_found(c);
        scanner_.at_end();
      }
      double value = 0;
      if (!scanner_.accept_number(value)) {
        if (breaks_off(c, line)) return false;
        scanner_.fail_number();
      }
      values[c] = value * scales_[c];
    }
    if (!scanner_.at_line_end())
      scanner_.fail(fmt::format("expected {} numbers per frame, found more: {}", scales_.size(),
                                excerpt(scanner_.word())));
    ++read_;
    return true;
  }

  // Whether the text ends here, but for a word without a line end behind it, in a frame that is not
  // the first.
  bool breaks_off(std::size_t found, std::size_t line) {
    const std::size_t stop = text_.find_first_of(" \t\r\n", place());
    const bool is_end =
        scanner_.at_line_end() ? TextScanner(scanner_).at_end() : stop == text_.npos;
    if (!is_end || read_ == 0) return false;
    motion_.warnings.push_back(
        fmt::format("line {} breaks off: {} of {} numbers of a frame; it is left out", line, found,
                    scales_.size()));
    return true;
  }

  void tell_count() {
    const Index stated = document_.stated_frames, found = document_.frames;
    if (stated == found) return;
    motion_.warnings.push_back(fmt::format("states {} frames but holds {}; {}", stated, found,
                                           found > stated ? "all are used" : "these are used"));
  }

  [[noreturn]] void fail_width_found(std::size_t found) {
    scanner_.fail(fmt::format("expected {} numbers per frame, found {}", scales_.size(), found));
  }

  // Lines are as many as frames should be: the hierarchy is not that of these lines.
  [[noreturn]] void fail_width(std::size_t line) {
    scanner_.fail(fmt::format("expected {} numbers per frame, found {} in line {}", scales_.size(),
                              first_width_, line));
  }

  std::string_view text_;
  TextScanner& scanner_;
  BvhDocument& document_;
  SkeletonMotion& motion_;
  std::vector<double> scales_;
  Index lines_per_frame_ = 1;
  std::size_t first_width_ = 0;  // words of the first line
  Index read_ = 0;               // whole frames so far
  std::optional<bool> fills_stated_;
};

}  // namespace

void read_bvh_motion(std::string_view text, TextScanner& scanner, double rate,
                     BvhDocument& document, SkeletonMotion& motion) {
  BvhMotionParser(text, scanner, document, motion).parse(rate);
}

}  // namespace moclean
