#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "moclean/core/matrix.hpp"
#include "moclean/formats/c3d_file.hpp"

namespace moclean {

/// The coordinates of a file, [frames x 3 per point of `coordinates`]; NaN where a point is invalid
/// (see c3d_format). Throws FileError for one that is infinite.
Matrix c3d_samples(const C3dFile& c3d, const std::filesystem::path& file);

/// How many samples of each point of a file were changed, all of `layout.points`.
struct C3dChanges {
  std::vector<std::int64_t> filled;     ///< were invalid, have coordinates now
  std::vector<std::int64_t> corrected;  ///< have other coordinates now
  std::vector<std::int64_t> lost;       ///< had coordinates, are invalid now

  bool any() const;
};

/// Puts coordinates into stored frames: `data` is of `layout`, a row of `before` and of `after` is
/// one of its frames. A point whose coordinates would be stored as they were keeps its bytes; any
/// other gets those of `after` and residual and camera mask 0, which is what the format has for
/// points that were not measured (c3d.org, "Notes for programmers"); one with a NaN becomes
/// invalid: coordinates 0, residual -1. Points at 0, 0, 0 without residual, which are missing only
/// if they are elsewhere in other frames, stay what they are. Throws FileError naming `file` for a
/// number beyond what the layout can hold.
C3dChanges put_c3d_samples(std::string& data, const C3dLayout& layout,
                           const std::vector<Index>& coordinates, const ConstMatrixRef& before,
                           const ConstMatrixRef& after, const std::filesystem::path& file);

/// Whether integers of the layout can hold all coordinates.
bool fit_c3d_integers(const ConstMatrixRef& samples, double scale);

/// Stored frames of integers as the same frames of reals; `unsigned_analog` says how the integers
/// of analog channels are meant.
std::string c3d_integers_as_reals(std::string_view data, const C3dLayout& layout,
                                  bool unsigned_analog);

}  // namespace moclean
