#include "moclean/noise/specification.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

template <class Number>
std::optional<Number> parse_whole(const std::string& text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

}  // namespace

NoiseSpecification::NoiseSpecification(std::string_view text) {
  const std::size_t colon = text.find(':');
  name_ = text.substr(0, colon);
  if (colon == std::string_view::npos) return;

  std::string_view rest = text.substr(colon + 1);
  while (true) {
    const std::size_t comma = rest.find(',');
    const std::string_view setting = rest.substr(0, comma);
    const std::size_t equals = setting.find('=');
    if (equals == std::string_view::npos || equals == 0)
      throw ArgumentError(fmt::format("noise {}: expected key=value, found '{}'", name_, setting));
    const std::string_view key = setting.substr(0, equals);
    if (has(key)) throw ArgumentError(fmt::format("noise {}: {} is given twice", name_, key));
    settings_.emplace_back(key, setting.substr(equals + 1));
    if (comma == std::string_view::npos) return;
    rest.remove_prefix(comma + 1);
  }
}

const std::string* NoiseSpecification::find(std::string_view key) const {
  const auto found = std::ranges::find(settings_, key, &std::pair<std::string, std::string>::first);
  return found == settings_.end() ? nullptr : &found->second;
}

bool NoiseSpecification::has(std::string_view key) const { return find(key) != nullptr; }

void NoiseSpecification::allow(std::initializer_list<std::string_view> keys) const {
  for (const auto& [key, value] : settings_)
    if (std::ranges::find(keys, key) == keys.end())
      throw ArgumentError(fmt::format("noise {}: unknown key '{}', expected one of {}", name_, key,
                                      fmt::join(keys, ", ")));
}

double NoiseSpecification::number(std::string_view key, double otherwise) const {
  const std::string* text = find(key);
  if (!text) return otherwise;
  const auto value = parse_whole<double>(*text);
  if (!value || !std::isfinite(*value))
    throw ArgumentError(fmt::format("noise {}: {} is '{}', expected a number", name_, key, *text));
  return *value;
}

Index NoiseSpecification::count(std::string_view key) const {
  const std::string* text = find(key);
  if (!text) throw ArgumentError(fmt::format("noise {} needs {}=COUNT", name_, key));
  const auto value = parse_whole<Index>(*text);
  if (!value || *value < 0)
    throw ArgumentError(fmt::format("noise {}: {} is '{}', expected a whole number of at least 0",
                                    name_, key, *text));
  return *value;
}

}  // namespace moclean
