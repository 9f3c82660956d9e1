#pragma once

#include <string>
#include <vector>

#include "moclean/formats/format.hpp"

namespace moclean {

/// What of a recording that was read from a file of the format `from` one of the format `to` cannot
/// hold, or has to make up: a sentence per kind; none where both are the same format.
std::vector<std::string> losses(const Recording& recording, const Format& from, const Format& to);

}  // namespace moclean
