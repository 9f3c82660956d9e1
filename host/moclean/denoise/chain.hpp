#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "moclean/denoise/automatic.hpp"
#include "moclean/denoise/denoiser.hpp"
#include "moclean/denoise/low_rank.hpp"
#include "moclean/filter/filter.hpp"

namespace moclean {

/// A matrix method and how the take is cut for it.
struct LowRank {
  Segmentation segmentation = {};
  Method method = RobustPca{};

  bool operator==(const LowRank&) const = default;
};

/// One step of cleaning.
using Step = std::variant<LowRank, Automatic, Filter>;

/// Steps one after the other, each works on what the one before made. There is at least one.
using Chain = std::vector<Step>;

/// What a specification leaves open.
struct StepDefaults {
  RobustPca robust_pca = {};  ///< of slra and rpca
  /// Of slra (else 200 frames), tslra (else 400), tsvd, svt and completion (else the take whole);
  /// rpca is always whole.
  std::optional<Segmentation> segmentation = {};
  Index overlap = 0;       ///< of the segments of every method that cuts the take
  bool automatic = false;  ///< segments of slra and tslra where it costs least
};

/// The names a step may begin with: auto, slra, rpca, tsvd, svt, completion, tslra and the filters.
std::vector<std::string_view> step_names();

/// Reads `hampel:window=7,sigmas=3+butterworth:cutoff=10`. The keys of a matrix method are its
/// parameters and, but for rpca, segment-length, segments
/// and overlap, and for slra and tslra segment=auto. Throws ArgumentError naming
/// the part that is wrong and what would be right.
Chain parse_chain(std::string_view specification, const StepDefaults& defaults = {});

/// The name of a step, and the specification that gives it whatever the defaults.
std::string name_of(const Step& step);
std::string to_string(const Step& step);
std::string to_string(const Chain& chain);

/// The first matrix method of a chain, whose segments are those of the result; null if it has none.
const LowRank* first_low_rank(const Chain& chain);

/// The first step that is no filter, so that it needs a backend; null if there is none.
const Step* first_on_backend(const Chain& chain);

inline bool needs_backend(const Chain& chain) { return first_on_backend(chain) != nullptr; }

/// The name of the first step that needs the frame rate; empty if none does.
std::string needs_frame_rate(const Chain& chain);

/// Whether the chain takes NaN for "not observed": all steps do up to one that leaves none
/// but in columns without a sample (completion, interpolate), or to the end.
bool accepts_missing(const Chain& chain);

/// Whether the result has a standard deviation per sample (Denoised::sigma).
bool has_sigma(const Chain& chain);

/// Copies of the samples of its takes that ChainDenoiser has at a time beside the takes, the
/// results but sigma among them.
std::uint64_t copies_held(const Chain& chain);

/// Runs a chain. The motion is what the last step made; the outliers are those of the method if it
/// is the only step, otherwise take - motion, 0 where either is missing. Segments are those of the
/// first matrix method; a chain of filters has none.
class ChainDenoiser final : public Denoiser {
 public:
  /// `backend` computes the matrix methods, is made ready for them and has to outlive this object;
  /// it may be null for a chain without any, else ArgumentError. Filters run on up to `jobs`
  /// threads.
  ChainDenoiser(Chain chain, Backend* backend, int jobs = 1);

  /// See Denoiser. Progress counts the segments of all matrix methods; a chain of filters reports
  /// nothing. A stop takes effect between filters. Throws ArgumentError for a take without the
  /// frame rate that a filter needs.
  std::vector<Denoised> denoise(std::span<const Recording> takes,
                                const Monitor& monitor = {}) override;

 private:
  std::vector<Denoised> solve(const Step& step, std::span<const Recording> takes,
                              const Monitor& monitor);

  Chain chain_;
  Backend* backend_;
  int jobs_;
};

}  // namespace moclean
