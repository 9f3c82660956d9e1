#include "moclean/formats/bvh.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "moclean/formats/bvh_motion.hpp"
#include "moclean/formats/skeleton_positions.hpp"
#include "moclean/formats/text_scanner.hpp"
#include "moclean/motion/framed_source.hpp"

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

bool is_number_with_comma(std::string_view word) {
  const std::size_t comma = word.find(',');
  return comma != word.npos && comma + 1 < word.size() && word[comma + 1] >= '0' &&
         word[comma + 1] <= '9' && word.find_first_not_of("0123456789+-eE,") == word.npos &&
         word.find(',', comma + 1) == word.npos;
}

// The text with a point in every number that has a comma: words between blanks are so told apart
// without doubt.
std::string with_points(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  std::string result(text);
  for (std::size_t comma = text.find(','); comma != text.npos; comma = text.find(',', comma + 1)) {
    const std::size_t first = text.find_last_of(blanks, comma) + 1;
    const std::size_t last = std::min(text.find_first_of(blanks, comma), text.size());
    if (is_number_with_comma(text.substr(first, last - first)))
      result[comma] = '.';
    else
      comma = last - 1;  // each word is looked at once
  }
  return result;
}

class BvhParser {
 public:
  BvhParser(std::string_view text, const std::filesystem::path& file)
      : text_(text), scanner_(text, file, {.marks = "{}"}) {}

  // `written` is the text as it stands in the file.
  SkeletonMotion parse(double rate, std::string_view written) {
    while (at_comment()) scanner_.next_line();
    scanner_.expect("HIERARCHY");
    while (!at_motion()) item();
    if (open_ >= 0)
      scanner_.fail(fmt::format("expected '}}' of joint {} before MOTION", excerpt(bone().name)));
    if (result_.skeleton.channels() == 0) scanner_.fail("no joint has a channel");
    tell_names_apart();
    read_bvh_motion(text_, scanner_, rate, document_, result_);
    document_.text = written;
    const std::uint64_t bytes = document_.text.size();
    result_.source = FramedSource{.file = std::make_shared<const BvhDocument>(std::move(document_)),
                                  .first = 0,
                                  .bytes = bytes};
    return std::move(result_);
  }

 private:
  bool at_comment() { return scanner_.peek() == '#' || scanner_.peek() == '/'; }

  bool at_motion() {
    while (at_comment()) scanner_.next_line();
    document_.motion = text_.size() - scanner_.bytes_left();
    return scanner_.accept("MOTION");
  }

  // Columns are found by their names.
  void tell_names_apart() {
    std::unordered_set<std::string> taken;
    for (const Bone& bone : result_.skeleton.bones) taken.insert(bone.name);
    if (taken.size() == result_.skeleton.bones.size()) return;
    std::unordered_map<std::string, Index> count;
    for (Bone& bone : result_.skeleton.bones) {
      Index& own = count[bone.name];
      if (++own == 1) continue;
      std::string name;
      do name = fmt::format("{}_{}", bone.name, own++);
      while (!taken.insert(name).second);
      --own;
      bone.name = name;
    }
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
  return skeleton_positions(parse_bvh(content, file, options.rate), file, content.size());
}

}  // namespace

SkeletonMotion parse_bvh(std::string_view text, const std::filesystem::path& file, double rate) {
  if (text.find(',') == text.npos) return BvhParser(text, file).parse(rate, text);
  return BvhParser(with_points(text), file).parse(rate, text);
}

constinit const Format bvh_format = {
    .name = "BVH",
    .extension = ".bvh",
    .notes =
        "any hierarchy, channels and rotation order; becomes joint positions, and rotations again "
        "on the skeleton of a BVH or ASF/AMC file",
    .content = {.names = true, .frame_rate = true, .skeleton = true},
    .read = read_bvh,
    .write = write_bvh,
};

}  // namespace moclean
