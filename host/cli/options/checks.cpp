#include "cli/options/checks.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <optional>
#include <system_error>
#include <utility>

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

// `problem` is empty for numbers within the range.
CLI::Validator number_check(std::function<std::string(double)> problem) {
  return {[problem = std::move(problem)](std::string& text) -> std::string {
            const auto number = number_in(text);
            if (!number) return "must be a number, " + found(text);
            const std::string wrong = problem(*number);
            if (!wrong.empty()) return fmt::format("{}, {}", wrong, found(text));
            return std::isinf(*number) ? "is too large, " + found(text) : "";
          },
          "", ""};
}

}  // namespace

CLI::Validator number() {
  return number_check([](double) { return ""; });
}

CLI::Validator positive_number() {
  return number_check([](double number) { return number > 0 ? "" : "must be positive"; });
}

CLI::Validator number_from_zero() {
  return number_check([](double number) { return number >= 0 ? "" : "must not be negative"; });
}

CLI::Validator number_above(double bound) {
  return number_check([=](double number) -> std::string {
    return number > bound ? "" : fmt::format("must be above {}", bound);
  });
}

CLI::Validator number_between(double least, double most) {
  return number_check([=](double number) -> std::string {
    if (number >= least && number <= most) return "";
    return least > 0 && number <= 0 ? "must be positive"
                                    : fmt::format("must be {} to {}", least, most);
  });
}

CLI::Validator whole_number(std::int64_t least, std::int64_t most) {
  return {[least, most](std::string& text) -> std::string {
            const auto number = whole_number_in(text);
            if (!number) return "must be a whole number, " + found(text);
            if (*number < least)
              return least == 1   ? "must be positive, " + found(text)
                     : least == 0 ? "must not be negative, " + found(text)
                                  : fmt::format("must be at least {}, {}", least, found(text));
            if (*number > most) return fmt::format("must be at most {}, {}", most, found(text));
            text = fmt::format("{}", *number);  // CLI11 would take 010 as 8
            return "";
          },
          "", ""};
}

CLI::Validator seed_number() {
  return {[](std::string& text) -> std::string {
            std::uint64_t number = 0;
            const char* const end = text.data() + text.size();
            const auto [stop, error] = std::from_chars(text.data(), end, number);
            if (text.empty() || stop != end || error != std::errc{})
              return fmt::format("must be a whole number from 0 to {}, {}", UINT64_MAX,
                                 found(text));
            text = fmt::format("{}", number);
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
