#pragma once

#include <cstdio>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/printable.hpp"

namespace moclean::cli {

/// Prints for a person on standard output. Names out of files cannot control the terminal.
template <class... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
  fmt::print("{}", printable(fmt::format(format, std::forward<Values>(values)...)));
}

/// Prints `moclean: ` and a message on standard error, in one piece, and a line end. Does not throw
/// where that is closed.
template <class... Values>
void warn(fmt::format_string<Values...> format, Values&&... values) {
  const std::string message = fmt::format(format, std::forward<Values>(values)...);
  std::fputs(fmt::format("moclean: {}\n", printable(message)).c_str(), stderr);
}

}  // namespace moclean::cli
