#include "moclean/core/specification.hpp"

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

Specification::Specification(std::string_view kind, std::string_view text) : kind_(kind) {
  const std::size_t colon = text.find(':');
  name_ = text.substr(0, colon);
  if (colon == std::string_view::npos) return;

  std::string_view rest = text.substr(colon + 1);
  while (true) {
    const std::size_t comma = rest.find(',');
    const std::string_view setting = rest.substr(0, comma);
    const std::size_t equals = setting.find('=');
    if (equals == std::string_view::npos || equals == 0)
      throw ArgumentError(
          fmt::format("{} {}: expected key=value, found '{}'", kind_, name_, setting));
    const std::string_view key = setting.substr(0, equals);
    if (has(key)) throw ArgumentError(fmt::format("{} {}: {} is given twice", kind_, name_, key));
    settings_.emplace_back(key, setting.substr(equals + 1));
    if (comma == std::string_view::npos) return;
    rest.remove_prefix(comma + 1);
  }
}

const std::string* Specification::find(std::string_view key) const {
  const auto found = std::ranges::find(settings_, key, &std::pair<std::string, std::string>::first);
  return found == settings_.end() ? nullptr : &found->second;
}

bool Specification::has(std::string_view key) const { return find(key) != nullptr; }

void Specification::allow(std::span<const std::string_view> keys) const {
  for (const auto& [key, value] : settings_)
    if (std::ranges::find(keys, key) == keys.end())
      throw ArgumentError(fmt::format("{} {}: unknown key '{}', expected one of {}", kind_, name_,
                                      key, fmt::join(keys, ", ")));
}

double Specification::number(std::string_view key, double otherwise) const {
  const std::string* text = find(key);
  if (!text) return otherwise;
  const auto value = parse_whole<double>(*text);
  if (!value || !std::isfinite(*value))
    throw ArgumentError(
        fmt::format("{} {}: {} is '{}', expected a number", kind_, name_, key, *text));
  return *value;
}

Index Specification::count(std::string_view key) const {
  const std::string* text = find(key);
  if (!text) throw ArgumentError(fmt::format("{} {} needs {}=COUNT", kind_, name_, key));
  const auto value = parse_whole<Index>(*text);
  if (!value || *value < 0)
    throw ArgumentError(fmt::format("{} {}: {} is '{}', expected a whole number of at least 0",
                                    kind_, name_, key, *text));
  return *value;
}

std::size_t Specification::choice(std::string_view key, std::span<const std::string_view> choices,
                                  std::size_t otherwise) const {
  const std::string* text = find(key);
  if (!text) return otherwise;
  const auto found = std::ranges::find(choices, *text);
  if (found == choices.end())
    throw ArgumentError(fmt::format("{} {}: {} is '{}', expected one of {}", kind_, name_, key,
                                    *text, fmt::join(choices, ", ")));
  return static_cast<std::size_t>(found - choices.begin());
}

void Specification::throw_unknown(std::span<const std::string_view> names) const {
  throw ArgumentError(
      fmt::format("unknown {} '{}', expected one of {}", kind_, name_, fmt::join(names, ", ")));
}

std::vector<std::string_view> split_chain(std::string_view chain) {
  std::vector<std::string_view> parts;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    if (chain[i] != '+') continue;
    const bool in_number = i + 1 < chain.size() && chain[i + 1] >= '0' && chain[i + 1] <= '9';
    if (in_number) continue;
    parts.push_back(chain.substr(begin, i - begin));
    begin = i + 1;
  }
  parts.push_back(chain.substr(begin));
  return parts;
}

}  // namespace moclean
