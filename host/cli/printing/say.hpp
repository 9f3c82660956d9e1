#pragma once

#include <cstdio>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/printable.hpp"

#include "cli/printing/standard_output.hpp"

namespace moclean::cli {

/// A text whose line feeds are ends of lines. Other texts that are printed are, or have in them,
/// names out of files and of files.
struct Lines {
  std::string text;
};

namespace detail {

template <class Value>
auto shown(const Value& value) {
  if constexpr (std::is_same_v<Value, Lines>)
    return printable(value.text);
  else if constexpr (std::is_convertible_v<const Value&, std::string_view>)
    return printable_line(value);
  else
    return value;
}

template <class Value>
using Shown = decltype(shown(std::declval<const Value&>()));

}  // namespace detail

/// Prints for a person on standard output. Names out of files cannot control the terminal, nor
/// begin a line: see printable_line().
template <class... Values>
void say(fmt::format_string<detail::Shown<Values>...> format, const Values&... values) {
  write_output(fmt::format(format, detail::shown(values)...));
}

/// Prints `moclean: ` and a message on standard error, in one piece, and a line end; likewise. Does
/// not throw where that is closed.
template <class... Values>
void warn(fmt::format_string<detail::Shown<Values>...> format, const Values&... values) {
  const std::string message = fmt::format(format, detail::shown(values)...);
  std::fputs(fmt::format("moclean: {}\n", message).c_str(), stderr);
}

}  // namespace moclean::cli
