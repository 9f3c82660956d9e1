#pragma once

#include <string_view>

namespace moclean {

/// The version of the library and of the program, as `0.1.0`.
std::string_view version();

}  // namespace moclean
