#include "moclean/formats/bvh.hpp"

#include <algorithm>
#include <any>
#include <array>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "moclean/formats/frame_rate.hpp"
#include "moclean/formats/text_scanner.hpp"

namespace moclean {
namespace {

constexpr std::array<std::pair<std::string_view, Channel>, 6> channel_names = {{
    {"Xposition", Channel::translate_x},
    {"Yposition", Channel::translate_y},
    {"Zposition", Channel::translate_z},
    {"Xrotation", Channel::rotate_x},
    {"Yrotation", Channel::rotate_y},
    {"Zrotation", Channel::rotate_z},
}};

class BvhParser {
 public:
  BvhParser(std::string_view text, const std::filesystem::path& file)
      : text_(text), scanner_(text, file, {.marks = "{}"}) {}

  SkeletonMotion parse() {
    scanner_.expect("HIERARCHY");
    while (!at_motion()) item();
    if (open_ >= 0)
      scanner_.fail(fmt::format("expected '}}' of joint {} before MOTION", excerpt(bone().name)));
    if (result_.skeleton.channels() == 0) scanner_.fail("no joint has a channel");
    frames();
    result_.source = std::move(document_);
    return std::move(result_);
  }

 private:
  // Keeps all text before MOTION.
  bool at_motion() {
    scanner_.peek();
    const std::size_t before = text_.size() - scanner_.bytes_left();
    if (!scanner_.accept("MOTION")) return false;
    document_.hierarchy = text_.substr(0, before);
    return true;
  }

  // The hierarchy may be nested as deep as it likes: `open_` and the parents are the only stack.
  void item() {
    if (open_ < 0) {
      if (!scanner_.accept("ROOT")) scanner_.fail_expected("ROOT or MOTION");
      open_joint();
    } else if (scanner_.accept("JOINT")) {
      open_joint();
    } else if (scanner_.accept("OFFSET")) {
      bone().offset = offset();
      has_offset_[static_cast<std::size_t>(open_)] = true;
    } else if (scanner_.accept("CHANNELS")) {
      channels();
    } else if (scanner_.accept("End")) {
      end_site();
    } else if (scanner_.accept("}")) {
      close_joint();
    } else {
      scanner_.fail_expected("OFFSET, CHANNELS, JOINT, End Site or '}'");
    }
  }

  void open_joint() {
    Bone joint;
    joint.name = scanner_.text_before('{');
    joint.parent = open_;
    if (joint.name.empty()) scanner_.fail_expected("the name of a joint");
    scanner_.expect("{");
    open_ = static_cast<int>(result_.skeleton.bones.size());
    result_.skeleton.bones.push_back(std::move(joint));
    has_offset_.push_back(false);
  }

  void close_joint() {
    if (!has_offset_[static_cast<std::size_t>(open_)])
      scanner_.fail(
          fmt::format("expected OFFSET in joint {}, found its end", excerpt(bone().name)));
    for (const Channel channel : bone().channels)
      if (is_translation(channel)) bone().offset[axis_of(channel)] = 0;
    open_ = bone().parent;
  }

  void end_site() {
    scanner_.text_before('{');  // "Site", or a name
    scanner_.expect("{");
    scanner_.expect("OFFSET");
    offset();
    scanner_.expect("}");
  }

  Eigen::Vector3d offset() {
    const double x = scanner_.number(), y = scanner_.number(), z = scanner_.number();
    return {x, y, z};
  }

  void channels() {
    if (!bone().channels.empty())
      scanner_.fail(fmt::format("joint {} has CHANNELS already", excerpt(bone().name)));
    for (Index left = scanner_.count(); left > 0; --left) bone().channels.push_back(channel());
  }

  Channel channel() {
    for (const auto& [name, channel] : channel_names)
      if (scanner_.accept(name)) return channel;
    scanner_.fail_expected("a channel (Xposition ... Zrotation)");
  }

  void frames() {
    scanner_.expect("Frames:");
    const Index frames = scanner_.count();
    document_.stated_frames = frames;
    if (frames == 0) scanner_.fail("expected at least one frame, found 'Frames: 0'");
    scanner_.expect("Frame");
    scanner_.expect("Time:");
    const double seconds = scanner_.number();
    if (seconds <= 0) scanner_.fail("expected a positive frame time");
    scanner_.expect_line_end();
    document_.frame_time = seconds;
    scanner_.at_end();  // to the first frame
    document_.motion = text_.substr(document_.hierarchy.size());
    document_.rows = document_.motion.size() - scanner_.bytes_left();
    result_.frame_rate = rate_from_period(seconds);

    // Memory for no more frames than the rest of the file can hold, two bytes a number at least,
    // and for one that begins but does not end.
    const auto width = static_cast<std::size_t>(result_.skeleton.channels());
    const auto room = static_cast<Index>(scanner_.bytes_left() / (2 * width) + 1);
    result_.channels.resize(std::min(frames, room), static_cast<Index>(width));
    const std::vector<double> scales = this->scales();
    for (Index f = 0; f < frames; ++f) {
      if (scanner_.at_end()) scanner_.fail(fmt::format("expected {} frames, found {}", frames, f));
      frame(result_.channels.row(f).data(), scales);
    }
    document_.all_frames = document_.frames = frames;
  }

  void frame(double* values, const std::vector<double>& scales) {
    for (std::size_t c = 0; c < scales.size(); ++c) {
      if (scanner_.at_line_end())
        scanner_.fail(fmt::format("expected {} numbers per frame, found {}", scales.size(), c));
      values[c] = scanner_.number() * scales[c];
    }
    if (!scanner_.at_line_end())
      scanner_.fail(fmt::format("expected {} numbers per frame, found more", scales.size()));
  }

  // What a number of a frame is multiplied with: degrees become radians.
  std::vector<double> scales() const {
    std::vector<double> scales;
    for (const Bone& bone : result_.skeleton.bones)
      for (const Channel channel : bone.channels)
        scales.push_back(is_translation(channel) ? 1 : std::numbers::pi / 180);
    return scales;
  }

  Bone& bone() { return result_.skeleton.bones[static_cast<std::size_t>(open_)]; }

  std::string_view text_;
  TextScanner scanner_;
  SkeletonMotion result_;
  BvhDocument document_;
  std::vector<bool> has_offset_;  // per joint
  int open_ = -1;                 // the joint whose braces are open
};

Recording read_bvh(std::string_view content, const std::filesystem::path& file,
                   const ReadOptions& options) {
  SkeletonMotion motion = parse_bvh(content, file);
  auto& document = std::any_cast<BvhDocument&>(motion.source);
  document.first_frame = options.frames.first.value_or(0);
  document.frames = options.frames.last.value_or(document.all_frames) - document.first_frame;
  return joint_positions(std::move(motion));
}

}  // namespace

SkeletonMotion parse_bvh(std::string_view text, const std::filesystem::path& file) {
  return BvhParser(text, file).parse();
}

constinit const Format bvh_format = {
    .name = "BVH",
    .extension = ".bvh",
    .notes =
        "any hierarchy, channels and rotation order; becomes joint positions, and rotations again "
        "when a recording of a BVH file is written",
    .content = {.names = true, .frame_rate = true, .skeleton = true},
    .read = read_bvh,
    .write = write_bvh,
};

}  // namespace moclean
