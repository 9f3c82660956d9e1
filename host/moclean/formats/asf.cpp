#include "moclean/formats/asf.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "moclean/formats/file.hpp"
#include "moclean/formats/text_scanner.hpp"

namespace moclean {
namespace {

constexpr std::array<std::pair<std::string_view, Channel>, 6> freedom_names = {{
    {"tx", Channel::translate_x},
    {"ty", Channel::translate_y},
    {"tz", Channel::translate_z},
    {"rx", Channel::rotate_x},
    {"ry", Channel::rotate_y},
    {"rz", Channel::rotate_z},
}};

// Angles about x, y, z; the first letter of the order turns first: XYZ is Rz Ry Rx.
struct EulerAngles {
  Eigen::Vector3d angles = Eigen::Vector3d::Zero();
  std::array<int, 3> order = {0, 1, 2};

  Eigen::Matrix3d rotation(double radians_per_angle) const {
    Eigen::Matrix3d product = Eigen::Matrix3d::Identity();
    for (const int axis : order)
      product = Eigen::AngleAxisd(angles[axis] * radians_per_angle, Eigen::Vector3d::Unit(axis)) *
                product;
    return product;
  }
};

class AsfParser {
 public:
  AsfParser(std::string_view text, const std::filesystem::path& file)
      : scanner_(text, file, {.blanks = " \t,()", .comment = '#'}) {}

  AcclaimSkeleton parse() {
    bool has_root = false, has_hierarchy = false;
    while (!scanner_.at_end()) {
      if (scanner_.accept(":units")) {
        units();
      } else if (scanner_.accept(":root")) {
        if (std::exchange(has_root, true)) scanner_.fail("expected one :root, found a second");
        root();
      } else if (scanner_.accept(":bonedata")) {
        if (!has_root) scanner_.fail("expected :root before :bonedata");
        while (!at_section()) bone();
      } else if (scanner_.accept(":hierarchy")) {
        if (!has_root) scanner_.fail("expected :root before :hierarchy");
        hierarchy();
        has_hierarchy = true;
      } else {
        if (scanner_.peek() != ':') scanner_.fail_expected("a section such as :units or :root");
        skip_section();
      }
    }
    if (!has_hierarchy) scanner_.fail_expected("a :hierarchy section");
    return depth_first();
  }

 private:
  bool at_section() { return scanner_.at_end() || scanner_.peek() == ':'; }

  void skip_section() {
    do scanner_.next_line();
    while (!at_section());
  }

  void units() {
    while (!at_section()) {
      if (scanner_.accept("angle")) {
        if (accept_any({"rad", "radian", "radians"}))
          radians_per_angle_ = 1;
        else if (!accept_any({"deg", "degree", "degrees"}))
          scanner_.fail_expected("deg or rad");
      }
      scanner_.next_line();
    }
  }

  bool accept_any(std::initializer_list<std::string_view> keywords) {
    return std::ranges::any_of(keywords,
                               [this](std::string_view word) { return scanner_.accept(word); });
  }

  void root() {
    Bone root;
    EulerAngles orientation;
    root.name = "root";
    while (!at_section()) {
      if (scanner_.accept("order"))
        root.channels = freedoms();
      else if (scanner_.accept("axis"))
        orientation.order = axis_order();
      else if (scanner_.accept("position"))
        root.offset = vector();
      else if (scanner_.accept("orientation"))
        orientation.angles = vector();
      scanner_.next_line();
    }
    root.before = orientation.rotation(radians_per_angle_);
    add(std::move(root));
  }

  void bone() {
    scanner_.expect("begin");
    Bone bone;
    EulerAngles axis;
    std::optional<Eigen::Vector3d> direction;
    std::optional<double> length;
    while (!scanner_.accept("end")) {
      if (at_section()) scanner_.fail_expected("'end' of a bone");
      if (scanner_.accept("name")) {
        bone.name = word_on_line("the name of a bone");
      } else if (scanner_.accept("direction")) {
        direction = vector();
      } else if (scanner_.accept("length")) {
        length = scanner_.number();
      } else if (scanner_.accept("axis")) {
        axis.angles = vector();
        axis.order = axis_order();
      } else if (scanner_.accept("dof")) {
        bone.channels = freedoms();
      }
      scanner_.next_line();
    }
    if (bone.name.empty() || !direction || !length)
      scanner_.fail(fmt::format("expected name, direction and length in a bone, bone {} lacks {}",
                                excerpt(bone.name),
                                bone.name.empty() ? "name" : (direction ? "length" : "direction")));
    bone.before = axis.rotation(radians_per_angle_);
    bone.after = bone.before.transpose();
    bone.tail = *direction * *length;
    add(std::move(bone));
  }

  void add(Bone bone) {
    if (!index_.emplace(bone.name, bones_.size()).second)
      scanner_.fail(fmt::format("there are two bones {}", excerpt(bone.name)));
    bones_.push_back(std::move(bone));
    children_.emplace_back();
  }

  void hierarchy() {
    scanner_.accept("begin");
    while (!at_section() && !scanner_.accept("end")) {
      const std::size_t parent = known_bone();
      while (!scanner_.at_line_end()) {
        const std::size_t child = known_bone();
        if (child == 0 || bones_[child].parent >= 0)
          scanner_.fail(fmt::format("bone {} has a parent already", excerpt(bones_[child].name)));
        bones_[child].parent = static_cast<int>(parent);
        children_[parent].push_back(child);
      }
    }
  }

  std::size_t known_bone() {
    const std::string_view name = scanner_.word();
    const auto found = index_.find(std::string(name));
    if (found == index_.end())
      scanner_.fail(fmt::format("expected the name of a bone, found {}", excerpt(name)));
    return found->second;
  }

  // Bones as the hierarchy lists them, so that parents stand before their children.
  AcclaimSkeleton depth_first() {
    AcclaimSkeleton result;
    result.radians_per_angle = radians_per_angle_;
    std::vector<std::pair<std::size_t, int>> open = {{0, -1}};  // bone, its parent's new index
    while (!open.empty()) {
      const auto [bone, parent] = open.back();
      open.pop_back();
      const int index = static_cast<int>(result.skeleton.bones.size());
      bones_[bone].parent = parent;
      result.skeleton.bones.push_back(bones_[bone]);
      for (std::size_t c = children_[bone].size(); c-- > 0;)
        open.emplace_back(children_[bone][c], index);
      bones_[bone].name.clear();  // reached
    }
    for (const Bone& bone : bones_)
      if (!bone.name.empty())
        scanner_.fail(fmt::format("bone {} does not hang on the root", excerpt(bone.name)));
    if (result.skeleton.channels() == 0) scanner_.fail("no bone has a degree of freedom");
    return result;
  }

  Eigen::Vector3d vector() {
    const double x = scanner_.number(), y = scanner_.number(), z = scanner_.number();
    return {x, y, z};
  }

  std::string_view word_on_line(std::string_view what) {
    if (scanner_.at_line_end()) scanner_.fail_expected(what);
    return scanner_.word();
  }

  std::array<int, 3> axis_order() {
    for (const std::array<int, 3>& order :
         {std::array{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}) {
      std::string letters;
      for (const int axis : order) letters += static_cast<char>('X' + axis);
      if (scanner_.accept(letters)) return order;
    }
    scanner_.fail_expected("an order of axes such as XYZ");
  }

  // Degrees of freedom up to the end of the line, reversed (see AcclaimSkeleton).
  std::vector<Channel> freedoms() {
    std::vector<Channel> channels;
    while (!scanner_.at_line_end()) {
      const auto known = std::find_if(freedom_names.begin(), freedom_names.end(),
                                      [this](auto& entry) { return scanner_.accept(entry.first); });
      if (known == freedom_names.end())
        scanner_.fail_expected("a degree of freedom (tx ty tz rx ry rz)");
      channels.push_back(known->second);
    }
    std::reverse(channels.begin(), channels.end());
    return channels;
  }

  TextScanner scanner_;
  double radians_per_angle_ = AcclaimSkeleton{}.radians_per_angle;
  std::vector<Bone> bones_;  // as the file lists them, root first
  std::vector<std::vector<std::size_t>> children_;
  std::unordered_map<std::string, std::size_t> index_;
};

}  // namespace

AcclaimSkeleton parse_asf(std::string_view text, const std::filesystem::path& file) {
  return AsfParser(text, file).parse();
}

AcclaimSkeleton read_asf(const std::filesystem::path& file) {
  return parse_asf(read_file(file), file);
}

}  // namespace moclean
