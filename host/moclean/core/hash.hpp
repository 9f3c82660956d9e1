#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

namespace moclean {

/// FNV-1a of 64 bits (Fowler, Noll, Vo), which unlike std::hash is the same everywhere: tells
/// versions of something apart, and is no protection.
class Fnv1a {
 public:
  Fnv1a& bytes(std::string_view text) {
    for (const char byte : text) add(static_cast<unsigned char>(byte));
    return *this;
  }
  /// With an end that no text holds: "a", "bc" is not "ab", "c".
  Fnv1a& text(std::string_view whole) {
    bytes(whole);
    add(0xff);
    return *this;
  }
  Fnv1a& word(std::uint64_t word) {
    for (int i = 0; i < 8; ++i) add(static_cast<unsigned char>(word >> (8 * i)));
    return *this;
  }
  Fnv1a& number(double number) { return word(std::bit_cast<std::uint64_t>(number)); }

  std::uint64_t value() const { return value_; }

 private:
  void add(unsigned char byte) { value_ = (value_ ^ byte) * 0x100000001b3U; }

  std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace moclean
