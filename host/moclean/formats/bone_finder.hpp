#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "moclean/motion/skeleton.hpp"

namespace moclean {

/// Finds bones by name. Frames name theirs in the same order, so the one that came after the last
/// one is tried first.
class BoneFinder {
 public:
  /// `bones` have to outlive the finder.
  explicit BoneFinder(const std::vector<Bone>& bones) : bones_(bones), follower_(bones.size()) {
    for (std::size_t b = 0; b < bones.size(); ++b) index_.emplace(bones[b].name, b);
  }

  std::optional<std::size_t> find(std::string_view name) {
    std::size_t& follower = follower_[last_];
    if (bones_[follower].name != name) {
      const auto found = index_.find(name);
      if (found == index_.end()) return std::nullopt;
      follower = found->second;
    }
    return last_ = follower;
  }

 private:
  const std::vector<Bone>& bones_;
  std::unordered_map<std::string_view, std::size_t> index_;
  std::vector<std::size_t> follower_;  // per bone: the one that came after it last time
  std::size_t last_ = 0;
};

}  // namespace moclean
