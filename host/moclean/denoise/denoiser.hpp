#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "moclean/backend/backend.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// One segment of a cleaned take; segments that overlap share frames.
struct DenoisedSegment {
  Index first_frame = 0;
  Index frames = 0;
  SegmentOutcome outcome;
};

/// What became of a take: matrices of its shape, in its unit, and what was found on the way. Names,
/// rate and all else stay with the take.
struct Denoised {
  Matrix motion;
  Matrix outliers;                   ///< what was taken away as gross error; zero where nothing was
  std::optional<Matrix> sigma = {};  ///< standard deviation of the motion, where the method has one
  std::optional<Mask> trusted = {};  ///< observed samples it did not reject, where it says
  std::vector<DenoisedSegment> segments = {};
  std::vector<std::string> unobserved = {};  ///< columns without a sample: NaN in the motion
  double solve_seconds =
      0;  ///< wall time; takes solved together share it by their number of frames
};

/// Of a take's samples in its result: motion and outliers. Memory is counted in such copies, at
/// most; those of masks and sigma by who asks for them.
inline constexpr std::uint64_t copies_in_result = 2;

/// Throws for the first take that no method can work on: ShapeError if it is empty or names another
/// number of columns than it has, TakeError naming frame and column of a sample that is infinite,
/// or NaN unless missing ones are accepted.
void require_usable(std::span<const Recording> takes, bool missing_accepted);

/// Cleans takes.
class Denoiser {
 public:
  virtual ~Denoiser() = default;

  /// Cleans all takes at once; the result of a take does not depend on the others, bit for bit.
  /// Throws what require_usable() throws.
  virtual std::vector<Denoised> denoise(std::span<const Recording> takes,
                                        const Monitor& monitor = {}) = 0;
};

}  // namespace moclean
