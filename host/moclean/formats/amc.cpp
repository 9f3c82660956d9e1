#include "moclean/formats/amc.hpp"

#include <memory>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "moclean/formats/bone_finder.hpp"
#include "moclean/formats/find_skeleton.hpp"
#include "moclean/formats/row_collector.hpp"
#include "moclean/formats/skeleton_positions.hpp"
#include "moclean/formats/text_scanner.hpp"
#include "moclean/motion/framed_source.hpp"

namespace moclean {
namespace {

class AmcParser {
 public:
  AmcParser(std::string_view text, const std::filesystem::path& file,
            const AcclaimSkeleton& skeleton)
      : text_(text),
        scanner_(text, file, {.comment = '#'}),
        bones_(skeleton.skeleton.bones),
        finder_(bones_),
        radians_per_angle_(skeleton.radians_per_angle),
        seen_in_(bones_.size(), 0),
        frames_(skeleton.skeleton.channels()) {
    std::size_t width = 0;
    for (const Bone& bone : bones_) {
      first_channel_.push_back(width);
      width += bone.channels.size();
      driven_ += !bone.channels.empty();
    }
  }

  Matrix parse() {
    header();
    document_.text = text_;
    document_.rows = text_.size() - scanner_.bytes_left();
    document_.radians_per_angle = radians_per_angle_;
    do frame();
    while (!scanner_.at_end());
    document_.first_number = number_ - frames_.count() + 1;
    document_.frames = frames_.count();
    return frames_.take();
  }

  // After parse().
  FramedSource source() {
    return {.file = std::make_shared<const AmcDocument>(std::move(document_)),
            .first = 0,
            .bytes = text_.size()};
  }

 private:
  void header() {
    while (scanner_.peek() == ':') {
      if (scanner_.accept(":DEGREES"))
        radians_per_angle_ = std::numbers::pi / 180;
      else if (scanner_.accept(":RADIANS"))
        radians_per_angle_ = 1;
      scanner_.next_line();
    }
  }

  bool at_frame_number() {
    const char c = scanner_.peek();
    return c >= '0' && c <= '9';
  }

  void frame() {
    if (!at_frame_number()) scanner_.fail_expected("a frame number");
    const Index number = scanner_.count();
    if (frames_.count() > 0 && number != number_ + 1)
      scanner_.fail(number > number_ + 1
                        ? fmt::format("expected frame {}, found {}: {} frames are missing between",
                                      number_ + 1, number, number - number_ - 1)
                        : fmt::format("expected frame {}, found {}", number_ + 1, number));
    scanner_.expect_line_end();
    number_ = number;
    frame_ = frames_.add(scanner_.bytes_left());
    std::size_t driven = 0;
    while (!scanner_.at_end() && !at_frame_number()) driven += bone();
    if (driven < driven_) fail_missing();
  }

  // One line `name value ...`; true if the bone has degrees of freedom.
  bool bone() {
    const std::size_t bone = find(scanner_.word());
    if (std::exchange(seen_in_[bone], frames_.count()) == frames_.count())
      scanner_.fail(
          fmt::format("frame {} gives bone {} twice", number_, excerpt(bones_[bone].name)));
    const std::vector<Channel>& channels = bones_[bone].channels;
    double* const values = frame_ + first_channel_[bone];
    // The file lists a bone's degrees of freedom in the reverse order of its channels.
    for (std::size_t c = channels.size(); c-- > 0;) {
      if (scanner_.at_line_end()) fail_count(bone, fmt::to_string(channels.size() - 1 - c));
      double value = 0;
      if (!scanner_.accept_number(value)) scanner_.fail_number();
      values[c] = value * (is_translation(channels[c]) ? 1 : radians_per_angle_);
    }
    if (!scanner_.at_line_end()) fail_count(bone, "more");
    return !channels.empty();
  }

  std::size_t find(std::string_view name) {
    const std::optional<std::size_t> bone = finder_.find(name);
    if (!bone)
      scanner_.fail(fmt::format("expected a bone of the skeleton, found {}", excerpt(name)));
    return *bone;
  }

  [[noreturn]] void fail_count(std::size_t bone, const std::string& found) {
    scanner_.fail(fmt::format("expected {} numbers for bone {}, found {}",
                              bones_[bone].channels.size(), excerpt(bones_[bone].name), found));
  }

  [[noreturn]] void fail_missing() {
    std::size_t bone = 0;
    while (bones_[bone].channels.empty() || seen_in_[bone] == frames_.count()) ++bone;
    scanner_.fail(fmt::format("expected bone {} in frame {}, found the frame's end",
                              excerpt(bones_[bone].name), number_));
  }

  std::string_view text_;
  TextScanner scanner_;
  const std::vector<Bone>& bones_;
  BoneFinder finder_;
  double radians_per_angle_;
  std::vector<std::size_t> first_channel_;  // per bone
  std::size_t driven_ = 0;                  // bones that have channels
  std::vector<Index> seen_in_;              // per bone: the last frame, from 1, that had it
  RowCollector frames_;
  double* frame_ = nullptr;  // the row being read
  Index number_ = 0;         // of the frame being read, as the file counts
  AmcDocument document_;
};

Recording read_amc(std::string_view content, const std::filesystem::path& file,
                   const ReadOptions& options) {
  const std::filesystem::path asf =
      options.skeleton.empty() ? find_skeleton(file) : options.skeleton;
  return skeleton_positions(parse_amc(content, file, read_asf(asf)), file, content.size());
}

}  // namespace

SkeletonMotion parse_amc(std::string_view text, const std::filesystem::path& file,
                         const AcclaimSkeleton& skeleton) {
  AmcParser parser(text, file, skeleton);
  Matrix channels = parser.parse();
  return {skeleton.skeleton, std::move(channels), 0, "ASF units", parser.source()};
}

constinit const Format amc_format = {
    .name = "ASF/AMC",
    .extension = ".amc",
    .notes =
        "the .asf is found beside the .amc (`14_06.amc`: `14.asf`) or given; positions in ASF "
        "units; written from AMC alone, within the skeleton's degrees of freedom",
    .content = {.names = true, .unit = true, .skeleton = true},
    .read = read_amc,
    .write = write_amc,
};

}  // namespace moclean
