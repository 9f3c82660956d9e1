#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "moclean/motion/clip.hpp"
#include "moclean/solve/backend.hpp"

namespace moclean {

/// One segment of a cleaned take; segments that overlap share frames.
struct DenoisedSegment {
  Index first_frame = 0;
  Index frames = 0;
  SegmentOutcome outcome;
};

/// A cleaned take.
struct Denoised {
  Clip clip;      ///< the motion
  Clip outliers;  ///< what was taken away as gross error, same shape; zero where nothing was
  std::optional<Clip> sigma = {};    ///< standard deviation of the motion, where the method has one
  std::optional<Mask> trusted = {};  ///< observed samples it did not reject, where it says
  std::vector<DenoisedSegment> segments = {};
  std::vector<std::string> unobserved = {};  ///< columns without a sample: NaN in the motion
  double solve_seconds =
      0;  ///< wall time; takes solved together share it by their number of frames
};

/// Of a take's samples in its result: motion and outliers. Memory is counted in such copies, at
/// most; those of masks and sigma by who asks for them.
inline constexpr std::uint64_t copies_in_result = 2;

/// Turns clips into clips.
class Denoiser {
 public:
  virtual ~Denoiser() = default;

  /// Cleans all takes at once; the result of a take does not depend on the others, bit for bit.
  /// Throws ShapeError naming the take's index, frame and column if a sample is infinite, or NaN
  /// where the method needs every sample.
  virtual std::vector<Denoised> denoise(std::span<const Clip> takes,
                                        const Monitor& monitor = {}) = 0;
};

}  // namespace moclean
