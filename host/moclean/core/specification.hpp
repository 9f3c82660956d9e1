#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// `name:key=value,key=value` taken apart: how noises, filters and methods are written on a command
/// line. Every member throws ArgumentError naming what is described, the key and what was expected.
class Specification {
 public:
  /// Splits the text. `kind` says in messages what is described: "noise", "method". Throws if a
  /// part is not `key=value` or a key stands twice.
  Specification(std::string_view kind, std::string_view text);

  const std::string& name() const { return name_; }
  bool has(std::string_view key) const;

  /// Throws if a key is given that is not among `keys`.
  void allow(std::span<const std::string_view> keys) const;
  void allow(std::initializer_list<std::string_view> keys) const {
    allow(std::span(keys.begin(), keys.size()));
  }

  /// The finite number given for `key`, or `otherwise` if the key is absent.
  double number(std::string_view key, double otherwise) const;

  /// The whole number >= 0 given for `key`, which has to be present.
  Index count(std::string_view key) const;

  /// Place among `choices` of the one given for `key`, or `otherwise` if the key is absent.
  std::size_t choice(std::string_view key, std::span<const std::string_view> choices,
                     std::size_t otherwise) const;

  /// The error of a name that is none of `names`.
  [[noreturn]] void throw_unknown(std::span<const std::string_view> names) const;

 private:
  const std::string* find(std::string_view key) const;

  std::string kind_;
  std::string name_;
  std::vector<std::pair<std::string, std::string>> settings_;
};

/// `a:x=1+b:y=2` taken apart at each `+` but those of numbers (`1e+5`). The parts may be empty.
std::vector<std::string_view> split_chain(std::string_view chain);

}  // namespace moclean
