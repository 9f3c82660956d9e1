#pragma once

#include <span>
#include <string>
#include <string_view>

namespace moclean::cli {

/// How many letters have to be put in, left out, replaced or exchanged with their neighbour to make
/// one text of the other (Damerau 1964, in the restricted form: no letter twice); capitals count as
/// small letters.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// `; did you mean 'slra'?` with the nearest name, if one is near enough to be a mistyped `text`,
/// else nothing.
std::string did_you_mean(std::string_view text, std::span<const std::string> names);

}  // namespace moclean::cli
