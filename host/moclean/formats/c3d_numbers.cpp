#include "moclean/formats/c3d_numbers.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace moclean {
namespace {

// F_floating (VAX Architecture Handbook): sign, 8 bits of exponent, 23 of fraction; the value is
// 0.1fraction in binary times 2 to the exponent - 128. Exponent 0 is zero, or with a sign reserved.
constexpr int vax_bias = 128, fraction_bits = 24;
constexpr std::uint32_t hidden_bit = 1U << (fraction_bits - 1);

double from_vax(std::uint32_t bits) {
  const int exponent = static_cast<int>(bits >> 23 & 0xFF);
  const bool is_negative = bits >> 31;
  if (exponent == 0) return is_negative ? std::numeric_limits<double>::quiet_NaN() : 0;
  const double size = std::ldexp(static_cast<double>((bits & (hidden_bit - 1)) | hidden_bit),
                                 exponent - vax_bias - fraction_bits);
  return is_negative ? -size : size;
}

std::uint32_t to_vax(double value) {
  constexpr std::uint32_t reserved = 1U << 31;
  if (std::isnan(value)) return reserved;
  int exponent = 0;
  double fraction = std::nearbyint(std::ldexp(std::frexp(std::abs(value), &exponent), 24));
  if (fraction == 2.0 * hidden_bit) {
    fraction /= 2;
    ++exponent;
  }
  if (fraction == 0 || exponent + vax_bias < 1) return 0;
  return (std::signbit(value) ? reserved : 0U) |
         static_cast<std::uint32_t>(exponent + vax_bias) << 23 |
         (static_cast<std::uint32_t>(fraction) & (hidden_bit - 1));
}

std::uint32_t byte(const char* bytes, int i) { return static_cast<unsigned char>(bytes[i]); }

}  // namespace

unsigned C3dNumbers::word(const char* bytes) const {
  return processor_ == C3dProcessor::mips ? byte(bytes, 0) << 8 | byte(bytes, 1)
                                          : byte(bytes, 1) << 8 | byte(bytes, 0);
}

double C3dNumbers::real(const char* bytes) const {
  if (processor_ == C3dProcessor::dec)  // words in the order of their size, bytes in the other
    return from_vax(word(bytes) << 16 | word(bytes + 2));
  const std::uint32_t bits = processor_ == C3dProcessor::mips ? word(bytes) << 16 | word(bytes + 2)
                                                              : word(bytes + 2) << 16 | word(bytes);
  return static_cast<double>(std::bit_cast<float>(bits));
}

std::array<char, 2> C3dNumbers::word_bytes(unsigned value) const {
  const auto low = static_cast<char>(value & 0xFF), high = static_cast<char>(value >> 8 & 0xFF);
  if (processor_ == C3dProcessor::mips) return {high, low};
  return {low, high};
}

std::array<char, 4> C3dNumbers::real_bytes(double value) const {
  const std::uint32_t bits = processor_ == C3dProcessor::dec
                                 ? to_vax(value)
                                 : std::bit_cast<std::uint32_t>(static_cast<float>(value));
  const auto high = word_bytes(bits >> 16), low = word_bytes(bits & 0xFFFF);
  if (processor_ == C3dProcessor::intel) return {low[0], low[1], high[0], high[1]};
  return {high[0], high[1], low[0], low[1]};
}

double C3dNumbers::largest() const {
  constexpr double vax = std::numeric_limits<float>::max() / 2.0;  // (1 - 2^-24) 2^127
  return processor_ == C3dProcessor::dec ? vax : std::numeric_limits<float>::max();
}

}  // namespace moclean
