#pragma once

#include <string_view>

namespace moclean {

/// Writes bytes to an open file, all of them: a signal or a full pipe may cut a write short.
/// Returns 0, or errno of the write that failed.
int write_whole(int descriptor, std::string_view bytes);

}  // namespace moclean
