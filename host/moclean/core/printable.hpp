#pragma once

#include <string>
#include <string_view>

namespace moclean {

/// A text as it may be shown on a terminal: bytes that would control it (escape sequences, carriage
/// returns, the C1 controls of UTF-8), those that are no UTF-8, and the characters that turn the
/// direction of writing, begin lines or are invisible tags (Unicode's bidirectional controls,
/// U+2028, U+2029, U+FEFF, U+E0000 to U+E007F) become \xNN. Line feeds stay, as does everything
/// else.
std::string printable(std::string_view text);

/// The same of what belongs on one line, the name of a file say: line feeds become \x0A.
std::string printable_line(std::string_view text);

}  // namespace moclean
