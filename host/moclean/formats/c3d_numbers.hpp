#pragma once

#include <array>
#include <cstdint>

namespace moclean {

/// The processor whose numbers a C3D file holds, by the byte that states it (c3d.org, "Parameter
/// section header"). Integers and reals of Intel and MIPS are IEEE 754, little and big endian; DEC
/// has integers as Intel and reals as the VAX's F_floating.
enum class C3dProcessor : unsigned char { intel = 84, dec = 85, mips = 86 };

/// Numbers of a C3D file: 16-bit integers and 4-byte reals in the order of its processor.
class C3dNumbers {
 public:
  explicit C3dNumbers(C3dProcessor processor) : processor_(processor) {}

  C3dProcessor processor() const { return processor_; }

  unsigned word(const char* bytes) const;  ///< without sign
  std::int16_t integer(const char* bytes) const { return static_cast<std::int16_t>(word(bytes)); }
  double real(const char* bytes) const;  ///< exact; NaN for the VAX's reserved operand

  std::array<char, 2> word_bytes(unsigned value) const;

  /// The nearest real of the processor; zero if it is too small, NaN's bytes are those of its kind.
  /// `value` is at most largest() in magnitude, or NaN.
  std::array<char, 4> real_bytes(double value) const;

  /// The largest number that real_bytes() takes.
  double largest() const;

 private:
  C3dProcessor processor_;
};

}  // namespace moclean
