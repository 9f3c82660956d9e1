#include "cli/options/checks.hpp"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/nearest.hpp"

namespace moclean::cli {
namespace {

std::optional<double> number_in(const std::string& text) {
  if (text.empty()) return std::nullopt;
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (*end != '\0' || std::isnan(number)) return std::nullopt;
  return number;
}

// Digits only, perhaps behind a sign; beyond 64 bits the nearest number of 64 bits.
std::optional<std::int64_t> whole_number_in(const std::string& text) {
  std::int64_t number = 0;
  const char *begin = text.data() + (text.starts_with('+') ? 1 : 0),
             *end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(begin, end, number);
  if (stop != end || begin == end || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) return text.starts_with('-') ? INT64_MIN : INT64_MAX;
  return number;
}

// Long values, and those of other kinds, in quotes.
std::string found(const std::string& text) {
  constexpr std::size_t shown = 40;
  return text.size() > shown ? fmt::format("found '{}...'", text.substr(0, shown))
                             : fmt::format("found '{}'", text);
}

}  // namespace

CLI::Validator positive_number() {
  return {[](std::string& text) -> std::string {
            const auto number = number_in(text);
            if (!number) return "must be a number, " + found(text);
            if (!(*number > 0)) return "must be positive, " + found(text);
            return std::isinf(*number) ? "is too large, " + found(text) : "";
          },
          "", ""};
}

CLI::Validator number_from_zero() {
  return {[](std::string& text) -> std::string {
            const auto number = number_in(text);
            if (!number) return "must be a number, " + found(text);
            if (!(*number >= 0)) return "must not be negative, " + found(text);
            return std::isinf(*number) ? "is too large, " + found(text) : "";
          },
          "", ""};
}

CLI::Validator whole_number(std::int64_t least, std::int64_t most) {
  return {[least, most](std::string& text) -> std::string {
            const auto number = whole_number_in(text);
            if (!number) return "must be a whole number, " + found(text);
            if (*number < least)
              return least == 1   ? "must be positive, " + found(text)
                     : least == 0 ? "must not be negative, " + found(text)
                                  : fmt::format("must be at least {}, {}", least, found(text));
            if (*number > most || *number == INT64_MAX)
              return most == INT64_MAX ? "is too large, " + found(text)
                                       : fmt::format("must be at most {}, {}", most, found(text));
            return "";
          },
          "", ""};
}

CLI::Validator one_of(std::vector<std::string> names) {
  const std::string description = fmt::format("{{{}}}", fmt::join(names, ","));
  return {[names = std::move(names)](std::string& text) -> std::string {
            if (std::ranges::find(names, text) != names.end()) return "";
            return fmt::format("expected {}{}, {}{}", names.size() > 1 ? "one of " : "",
                               fmt::join(names, ", "), found(text), did_you_mean(text, names));
          },
          description, ""};
}

}  // namespace moclean::cli
