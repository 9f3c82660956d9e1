#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "moclean/denoise/denoiser.hpp"
#include "moclean/segment/spans.hpp"

namespace moclean {

/// How a take is cut. Exactly one of the first three is meant: whole, a number of segments, or a
/// length.
struct Segmentation {
  bool whole = false;  ///< one segment (rpca)
  Index segments = 0;  ///< > 0: so many equal segments
  Index length = 200;  ///< otherwise: equal segments of about so many frames
  Index overlap = 0;   ///< frames that neighbours share (overlapping_spans) and that are blended

  bool cheapest = false;  ///< so many segments, but as cost least (cheapest_plans.hpp)

  bool operator==(const Segmentation&) const = default;
};

/// The equal plan for a take of `frames` frames; an automatic one has as many segments.
SegmentPlan plan(const Segmentation& segmentation, Index frames);

/// Of samples so small that no square of theirs is a number, why a matrix method cannot work on
/// them: it would make zeros of them. Empty of all others. `name` is the method's.
std::string too_small(const Matrix& samples, std::string_view name);

/// Copies of the samples of its takes that LowRankDenoiser has at a time, the results among them.
std::uint64_t copies_held(const Segmentation& segmentation);

/// A matrix method segment by segment: cut, split every segment, stitch. With robust PCA it is the
/// segmented low-rank approximation of Peng et al.; with Segmentation{.whole = true} plain RPCA of
/// the take. NaN is refused unless the method accepts it; the completed clip then has none but
/// in columns without a single sample.
/// Segments that overlap are each solved with all their frames; motion and outliers are blended
/// with the same weights, so that they add up to the take as those of a segment do.
class LowRankDenoiser final : public Denoiser {
 public:
  /// `backend` is used by denoise() and has to outlive this object. Up to `jobs` threads take
  /// results out of batches.
  LowRankDenoiser(Segmentation segmentation, Method method, Backend& backend, int jobs = 1)
      : segmentation_(segmentation), method_(std::move(method)), backend_(backend), jobs_(jobs) {}

  std::vector<Denoised> denoise(std::span<const Recording> takes,
                                const Monitor& monitor = {}) override;

 private:
  Segmentation segmentation_;
  Method method_;
  Backend& backend_;
  int jobs_;
};

}  // namespace moclean
