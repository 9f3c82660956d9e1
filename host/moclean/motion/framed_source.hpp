#pragma once

#include <any>
#include <cstdint>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// A Recording::source that knows of each of its frames: excerpt() keeps in step where in it the
/// recording begins, and thinned() drops it, for no file of the format's has such frames.
struct FramedSource {
  std::any file;            ///< of a type of the format's own, cheap to copy; all frames
  Index first = 0;          ///< that of its frames with which the recording begins
  std::uint64_t bytes = 0;  ///< of memory that it takes
};

}  // namespace moclean
