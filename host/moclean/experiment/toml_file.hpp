#pragma once

#include <filesystem>

#include "moclean/core/error.hpp"

// What toml++ asserts of a file that is no TOML at all ends no program of ours, and is not assumed
// either, as it would be with NDEBUG. Nobody includes toml++ but through here: its functions are
// inline, and have to be the same everywhere. It takes a while to compile.
#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_EXCEPTIONS 0
#define TOML_ASSERT(expression) \
  ((expression) ? static_cast<void>(0) : ::moclean::fail_assertion_of_toml())

namespace moclean {

[[noreturn]] void fail_assertion_of_toml();

}  // namespace moclean

#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace moclean {

/// Reads a TOML file. Throws FileError naming file, line and what is wrong.
toml::table read_toml(const std::filesystem::path& file);

}  // namespace moclean
