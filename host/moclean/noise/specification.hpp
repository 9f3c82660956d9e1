#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// `name:key=value,key=value` taken apart. Every member throws ArgumentError naming the noise, the
/// key and what was expected.
class NoiseSpecification {
 public:
  /// Splits the text. Throws if a part is not `key=value` or a key stands twice.
  explicit NoiseSpecification(std::string_view text);

  const std::string& name() const { return name_; }
  bool has(std::string_view key) const;

  /// Throws if a key is given that is not among `keys`.
  void allow(std::initializer_list<std::string_view> keys) const;

  /// The finite number given for `key`, or `otherwise` if the key is absent.
  double number(std::string_view key, double otherwise) const;

  /// The whole number >= 0 given for `key`, which has to be present.
  Index count(std::string_view key) const;

 private:
  const std::string* find(std::string_view key) const;

  std::string name_;
  std::vector<std::pair<std::string, std::string>> settings_;
};

}  // namespace moclean
