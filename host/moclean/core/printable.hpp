#pragma once

#include <string>
#include <string_view>

namespace moclean {

/// A text as it may be shown on a terminal: bytes that would control it (escape sequences, carriage
/// returns, the C1 controls of UTF-8) and those that are no UTF-8 become \xNN. Line feeds stay, as
/// does everything else.
std::string printable(std::string_view text);

}  // namespace moclean
