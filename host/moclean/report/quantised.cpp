#include "moclean/report/quantised.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace moclean {
namespace {

constexpr double largest_code = std::numeric_limits<std::int16_t>::max();

struct Range {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
};

Range range_of(const ConstMatrixRef& matrix, Index column) {
  Range range;
  for (Index r = 0; r < matrix.rows(); ++r) {
    const double value = matrix(r, column);
    if (!std::isfinite(value)) continue;
    range.least = std::min(range.least, value);
    range.most = std::max(range.most, value);
  }
  return range;
}

std::int16_t code_of(double value, double offset, double step) {
  if (!std::isfinite(value)) return Quantised::missing;
  if (step == 0) return 0;
  return static_cast<std::int16_t>(
      std::clamp(std::round((value - offset) / step), -largest_code, largest_code));
}

}  // namespace

Quantised quantise(const ConstMatrixRef& matrix) {
  Quantised result;
  result.codes.resize(static_cast<std::size_t>(matrix.size()));
  for (Index c = 0; c < matrix.cols(); ++c) {
    const Range range = range_of(matrix, c);
    const bool is_empty = range.least > range.most;
    // Halves first: the difference of two large numbers may not be finite.
    const double offset = is_empty ? 0 : range.least / 2 + range.most / 2;
    const double step = is_empty ? 0 : (range.most / 2 - range.least / 2) / largest_code;
    for (Index r = 0; r < matrix.rows(); ++r)
      result.codes[static_cast<std::size_t>(r * matrix.cols() + c)] =
          code_of(matrix(r, c), offset, step);
    result.offset.push_back(offset);
    result.step.push_back(step);
  }
  return result;
}

Matrix restore(const Quantised& quantised) {
  const auto columns = static_cast<Index>(quantised.step.size());
  if (columns == 0) return {};
  Matrix matrix(static_cast<Index>(quantised.codes.size()) / columns, columns);
  for (Index r = 0; r < matrix.rows(); ++r)
    for (Index c = 0; c < columns; ++c) {
      const std::int16_t code = quantised.codes[static_cast<std::size_t>(r * columns + c)];
      const auto column = static_cast<std::size_t>(c);
      matrix(r, c) = code == Quantised::missing
                         ? std::numeric_limits<double>::quiet_NaN()
                         : quantised.offset[column] + quantised.step[column] * code;
    }
  return matrix;
}

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= count ? letters[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::string base64(std::span<const std::int16_t> codes) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(2 * codes.size());
  for (const std::int16_t code : codes) {
    const auto bits = static_cast<std::uint16_t>(code);
    bytes.push_back(static_cast<std::uint8_t>(bits & 0xFFU));
    bytes.push_back(static_cast<std::uint8_t>(bits >> 8));
  }
  return base64(bytes);
}

}  // namespace moclean
