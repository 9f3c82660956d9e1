#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace moclean {

/// Reads a number of bytes: a number above 0, alone or followed by K, M, G or T (1024 each time;
/// any case, `MB` and `MiB` mean M). Throws ArgumentError for anything else; `option` is for the
/// message.
std::uint64_t parse_byte_size(std::string_view option, const std::string& text);

/// The same number for people: `512 B`, `1.5 GiB`.
std::string byte_text(std::uint64_t bytes);

}  // namespace moclean
