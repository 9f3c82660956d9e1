#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// A matrix in whole numbers of 16 bits: value(r, c) = offset[c] + step[c] * codes(r, c).
///
/// The values of a column use the whole range of codes, so that a value is off by step[c] / 2 at
/// most, which is 1 / 131 068 of the column's range. NaN and infinities become `missing`.
struct Quantised {
  static constexpr std::int16_t missing = std::numeric_limits<std::int16_t>::min();

  std::vector<std::int16_t> codes;  ///< [rows x columns], row-major
  std::vector<double> offset;       ///< per column
  std::vector<double> step;         ///< per column; 0 where all values are equal
};

Quantised quantise(const ConstMatrixRef& matrix);

/// The matrix again, NaN where a value is missing.
Matrix restore(const Quantised& quantised);

/// Base64 of the codes, each as two bytes, low byte first (RFC 4648, with padding).
std::string base64(std::span<const std::int16_t> codes);
std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace moclean
