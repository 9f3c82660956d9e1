#pragma once

#include <array>
#include <string_view>

#include "moclean/core/parameters.hpp"
#include "moclean/denoise/denoiser.hpp"
#include "moclean/segment/plan.hpp"

namespace moclean {

/// Whether what a take shows of its body is used.
enum class BodyRules { on, off };

/// Which observed samples may be rejected. automatic: as `on`, but where bones say that quick
/// motion was rejected, it is kept, and the take solved again. off: none; what is observed counts,
/// whatever it is. gentle: what twice the usual residual speaks against, and lost zeros; distances
/// reject nothing. on: what distances or residuals speak against.
enum class Rejection { automatic, off, gentle, on };

/// Whether samples that are not rejected are smoothed, or pass through to the last bit.
enum class Smoothing { on, off };

/// Whether the confidence of samples weighs them, see confidence_weights().
enum class Confidence { on, off };

/// Cleaning without parameters to choose: matrix-normal smoothing
/// (methods/matrix_normal/matrix_normal.hpp) of overlapping windows, told by the distances between
/// joints which samples are wrong. Works on any columns; where all come in joints of three, the
/// body's rules apply (moclean/body):
///   joints lost and written as zeros are missing (vanished), joints at wrong distances are
///   rejected before anything is fitted (rigid_flags), limbs that jump away and back are
///   (jump_flags), exact distances hold in gaps, and a take is split where another motion begins
///   (splices): no window reaches across. Soft marker sets have no constant distances, and no such
///   rules.
/// Times are in seconds where it matters: rates of 25 to 250 Hz. Joints and columns that never
/// change stay as they are, and have no say (moving_part.hpp). Adding a constant to a column adds
/// it to the result, but for joints that zeros make lost.
struct Automatic {
  Index window = 2000;  ///< frames; longer takes are divided equally into about so many, at least 8
  Index overlap = 100;  ///< frames that neighbouring windows share, at least 0
  BodyRules body = BodyRules::on;
  Rejection reject = Rejection::automatic;
  Smoothing smooth = Smoothing::on;
  Confidence confidence = Confidence::on;

  bool operator==(const Automatic&) const = default;

  static constexpr std::string_view name = "auto";
  static constexpr std::array<std::string_view, 2> choices = {"on", "off"};
  static constexpr std::array<std::string_view, 4> rejections = {"auto", "off", "gentle", "on"};
  static void visit(auto& self, auto& visitor) {
    visitor("window", self.window);
    visitor("overlap", self.overlap);
    visitor("body", self.body, choices);
    visitor("reject", self.reject, rejections);
    visitor("smooth", self.smooth, choices);
    visitor("confidence", self.confidence, choices);
  }
};

/// The windows of a take without splices, before they overlap.
SegmentPlan plan(const Automatic& method, Index frames);

/// Copies of the samples of its takes that AutomaticDenoiser has at a time, the results but sigma
/// among them: as with segments that overlap.
std::uint64_t copies_held(const Automatic& method);

/// Throws ArgumentError naming the first parameter out of its range.
void check(const Automatic& method);

/// Runs Automatic. Results have `trusted` and `sigma`; outliers are what was rejected. A take
/// without a frame rate counts as one of 120 Hz. NaN means missing; columns that a window has no
/// sample of stay NaN in it. Throws TakeError for a take with an infinite sample, and for one whose
/// frames tell nothing of each other (smooth_in_time.hpp).
class AutomaticDenoiser final : public Denoiser {
 public:
  /// `backend` is used by denoise() and has to outlive this object. Up to `jobs` threads do
  /// what concerns one take alone; the result does not depend on them.
  AutomaticDenoiser(const Automatic& method, Backend& backend, int jobs = 1)
      : method_(method), backend_(backend), jobs_(jobs) {}

  std::vector<Denoised> denoise(std::span<const Recording> takes,
                                const Monitor& monitor = {}) override;

 private:
  Automatic method_;
  Backend& backend_;
  int jobs_;
};

}  // namespace moclean
