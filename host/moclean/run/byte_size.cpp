#include "moclean/run/byte_size.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

constexpr std::string_view prefixes = "KMGT";

// The power of 1024 that a suffix stands for; -1 if it is none.
int power_of(std::string_view suffix) {
  std::string upper(suffix);
  for (char& c : upper)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  if (upper.empty() || upper == "B") return 0;
  const std::size_t place = prefixes.find(upper.front());
  upper.erase(0, 1);
  const bool known = upper.empty() || upper == "B" || upper == "IB";
  return place == prefixes.npos || !known ? -1 : static_cast<int>(place) + 1;
}

}  // namespace

std::uint64_t parse_byte_size(std::string_view option, const std::string& text) {
  const char* const end = text.data() + text.size();
  double value = 0;
  const auto [after, error] = std::from_chars(text.data(), end, value, std::chars_format::fixed);
  const int power = error == std::errc{} ? power_of({after, end}) : -1;
  const double bytes = std::floor(std::ldexp(value, 10 * power));
  constexpr double most = 0x1p62;
  if (power < 0 || !(bytes >= 1) || bytes > most)
    throw ArgumentError(
        fmt::format("{} is '{}', expected a number of bytes such as 512M or 2G", option, text));
  return static_cast<std::uint64_t>(bytes);
}

std::string byte_text(std::uint64_t bytes) {
  if (bytes < 1024) return fmt::format("{} B", bytes);
  auto value = static_cast<double>(bytes);
  std::size_t power = 0;
  for (; value >= 1024 && power < prefixes.size(); ++power) value /= 1024;
  return fmt::format("{:.4g} {}iB", value, prefixes[power - 1]);
}

}  // namespace moclean
