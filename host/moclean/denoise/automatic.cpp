#include "moclean/denoise/automatic.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "moclean/body/length_noise.hpp"
#include "moclean/body/taken_back.hpp"
#include "moclean/core/error.hpp"
#include "moclean/core/parallel.hpp"
#include "moclean/denoise/body_findings.hpp"
#include "moclean/denoise/confidence_weights.hpp"
#include "moclean/denoise/low_rank.hpp"
#include "moclean/denoise/moving_part.hpp"
#include "moclean/denoise/sample_status.hpp"
#include "moclean/denoise/smooth_in_time.hpp"
#include "moclean/denoise/unobserved.hpp"
#include "moclean/segment/spans.hpp"

namespace moclean {
namespace {

constexpr double usual_rate = 120;                             // Hz, where none is known
constexpr double median_seconds = 0.058, lag_seconds = 0.067;  // of the first guess
constexpr Index shortest_window = 8;
constexpr double gentle_factor = 2;     // of the thresholds
constexpr double no_threshold = 1e150;  // its square is finite, and above that of any residual
constexpr double missing = std::numeric_limits<double>::quiet_NaN();

double rate_of(const Recording& take) { return take.frame_rate > 0 ? take.frame_rate : usual_rate; }

// Whether all columns come in joints of three, enough of them for a body.
bool has_body(const Recording& take) {
  for (const Joint& joint : joints(take))
    if (joint.columns != 3) return false;
  return take.samples.cols() >= 6;
}

// A take as the windows see it.
struct Prepared {
  Matrix samples;     // NaN where missing or flagged
  MotionPrior prior;  // of the whole take
  NoisyBones bones;   // of the whole take, or empty
  Spans spans;
};

void drop(const Mask& joints, Matrix& samples) {
  for (Index i = 0; i < joints.rows(); ++i)
    for (Index j = 0; j < joints.cols(); ++j)
      if (joints(i, j)) samples.row(i).segment<3>(3 * j).setConstant(missing);
}

// The windows of a take in which other motions begin at the frames `splices`.
Spans windows(const Automatic& method, Index frames, std::vector<Index> splices) {
  Spans all;
  Index first = 0;
  splices.push_back(frames);
  for (const Index last : splices) {
    for (const Span& span : overlapping_spans(plan(method, last - first), method.overlap))
      all.push_back({first + span.first, first + span.last});
    first = last;
  }
  return all;
}

// Takes flags back where a window would be left with hardly a sample of a joint: rather wrong than
// nothing to go by.
void spare_hopeless(const Mask& seen, const Spans& spans, Mask& bad) {
  constexpr double least_share = 0.05;
  for (const Span& span : spans)
    for (Index j = 0; j < bad.cols(); ++j) {
      const auto present = seen.col(j).segment(span.first, span.frames());
      auto flagged = bad.col(j).segment(span.first, span.frames());
      const auto left = static_cast<double>((present && !flagged).count());
      if (left < least_share * static_cast<double>(present.count())) flagged.setConstant(false);
    }
}

// Takes out what the body says is wrong, and splits where another motion begins.
void look_at_body(double frame_rate, const Automatic& method, Prepared& prepared) {
  const BodyTake take = body_take(prepared.samples, frame_rate);
  BodyFindings found = look_at(take, prepared.samples);
  if (found.prior.size <= 0) return;
  if (!found.other_motions.empty())
    prepared.spans = windows(method, take.frames(), found.other_motions);
  if (method.reject == Rejection::off || method.reject == Rejection::gentle)
    found.bad.setConstant(false);
  spare_hopeless(take.seen, prepared.spans, found.bad);
  drop(found.bad, prepared.samples);
  fill_from_body(take, found);
  prepared.prior = std::move(found.prior);
  prepared.bones = std::move(found.bones);
}

Prepared prepare(const Recording& take, const Automatic& method) {
  Prepared prepared{.samples = take.samples, .prior = {}, .bones = {}, .spans = {}};
  prepared.spans = windows(method, take.frames(), {});
  if (method.body == BodyRules::on && has_body(take)) look_at_body(rate_of(take), method, prepared);
  if (method.confidence == Confidence::on) prepared.prior.confidence = confidence_weights(take);
  return prepared;
}

MotionPrior excerpt(const MotionPrior& known, const Span& span) {
  MotionPrior part{.size = known.size, .noise = known.noise, .links = known.links};
  if (known.confirmed.size() > 0)
    part.confirmed = known.confirmed.middleRows(span.first, span.frames());
  if (known.positions.size() > 0) {
    part.positions = known.positions.middleRows(span.first, span.frames());
    part.variance = known.variance.middleRows(span.first, span.frames());
  }
  if (known.confidence.size() > 0)
    part.confidence = known.confidence.middleRows(span.first, span.frames());
  return part;
}

// What the windows of one solve have in common: columns, and frames or columns per joint.
MatrixNormal matrix_normal_of(const Recording& take, Rejection reject) {
  MatrixNormal method{.joint_columns = has_body(take) ? 3 : 1,
                      .median_frames = odd_frames(median_seconds, rate_of(take)),
                      .lag_frames = std::max<Index>(1, std::lround(lag_seconds * rate_of(take)))};
  for (double* threshold : {&method.soft_first, &method.soft_last, &method.hard}) {
    if (reject == Rejection::gentle) *threshold *= gentle_factor;
    if (reject == Rejection::off) *threshold = no_threshold;
  }
  return method;
}

// Takes whose windows share one solve.
struct Stack {
  MatrixNormal method;
  std::vector<std::size_t> takes;
  // Once they are stacked:
  std::vector<Index> first_segments = {};  // of the takes
  std::vector<MotionPrior> priors = {};    // of the segments
};

// Some of the takes, by columns and by what the method depends on; those that stand still are in
// none.
std::vector<Stack> stacks_of_alike(std::span<const MovingPart> parts,
                                   std::span<const std::size_t> some, Rejection reject) {
  std::vector<Stack> stacks;
  for (const std::size_t t : some) {
    if (parts[t].columns.empty()) continue;
    MatrixNormal method = matrix_normal_of(parts[t].clip, reject);
    const auto alike = [&](const Stack& stacked) {
      return stacked.method == method &&
             parts[stacked.takes.front()].columns.size() == parts[t].columns.size();
    };
    const auto found = std::ranges::find_if(stacks, alike);
    if (found == stacks.end())
      stacks.push_back({std::move(method), {t}});
    else
      found->takes.push_back(t);
  }
  return stacks;
}

// The windows of a stack one below the other; their priors go to it.
SegmentBatch stack(std::span<const Prepared> prepared, Stack& stacked) {
  std::vector<Index> first_row = {0};
  for (const std::size_t t : stacked.takes) {
    stacked.first_segments.push_back(static_cast<Index>(first_row.size()) - 1);
    for (const Span& span : prepared[t].spans) {
      first_row.push_back(first_row.back() + span.frames());
      stacked.priors.push_back(excerpt(prepared[t].prior, span));
    }
  }
  SegmentBatch data(prepared[stacked.takes.front()].samples.cols(), std::move(first_row));
  for (std::size_t i = 0; i < stacked.takes.size(); ++i) {
    const Prepared& take = prepared[stacked.takes[i]];
    stack_spans(take.samples, take.spans, data, stacked.first_segments[i]);
  }
  return data;
}

// What moves in each take. Throws for the first in which nothing moves as motion does.
std::vector<MovingPart> moving_parts(std::span<const Recording> takes, const Automatic& method,
                                     int jobs) {
  const bool find_lost = method.body == BodyRules::on && method.reject != Rejection::off;
  std::vector<MovingPart> parts(takes.size());
  std::vector<char> smooth(takes.size());
  for_each_index(static_cast<Index>(takes.size()), jobs, [&](Index t) {
    const auto i = static_cast<std::size_t>(t);
    parts[i] = moving_part(takes[i], find_lost);
    smooth[i] = smooth_in_time(parts[i]);
  });
  if (const auto found = std::ranges::find(smooth, 0); found != smooth.end())
    throw TakeError(static_cast<std::size_t>(found - smooth.begin()),
                    "its rows are not smooth in time (a frame tells nothing of the next), and auto "
                    "is for motion; for a matrix that is no motion use rpca (--method rpca)");
  return parts;
}

// A fill that may be a body's size away is none.
void leave_unknown(const Recording& take, double size, Denoised& result) {
  if (size <= 0) return;
  const Mask unknown = take.samples.array().isNaN() && result.sigma->array() > size;
  result.motion = unknown.select(missing, result.motion);
  *result.sigma = unknown.select(missing, *result.sigma);
}

// Goes back towards trusted samples where that is nearer to the truth than all the way.
void go_back(const Recording& take, const Mask& trusted, Matrix& motion) {
  const Matrix samples = trusted.select(take.samples, missing);
  const double share = worthwhile_share(body_take(samples, rate_of(take)), motion);
  motion = trusted.select(take.samples + share * (motion - take.samples), motion);
}

Denoised result_of(const Recording& take, const Prepared& prepared, const Solution& solution,
                   Index segment) {
  const Spans& spans = prepared.spans;
  Matrix motion = blend_spans(solution.low_rank, spans, segment);
  const Mask observed = !take.samples.array().isNaN();
  const Mask trusted = observed && blend_spans(*solution.trusted, spans, segment).array() >= 0.5;
  if (prepared.prior.noise > 0) go_back(take, trusted, motion);
  Denoised result;
  result.motion = std::move(motion);
  result.sigma = blend_spans(*solution.deviation, spans, segment);
  result.trusted = trusted;
  leave_unknown(take, prepared.prior.size, result);
  for (std::size_t s = 0; s < spans.size(); ++s)
    result.segments.push_back({spans[s].first, spans[s].frames(),
                               solution.segments[static_cast<std::size_t>(segment) + s]});
  return result;
}

// Where samples were rejected though a bone says that they are right: accelerations that were taken
// for errors, [frames x joints].
Mask rejected_motion(const MovingPart& part, const Prepared& prepared, const Denoised& result) {
  const NoisyBones& bones = prepared.bones;
  if (bones.empty()) return {};
  Mask rejected(bones.off.rows(), bones.off.cols());
  Matrix displaced(rejected.rows(), rejected.cols());
  for (Index j = 0; j < rejected.cols(); ++j) {
    const auto samples = part.clip.samples.middleCols<3>(3 * j);
    const auto trusted = result.trusted->middleCols<3>(3 * j);
    rejected.col(j) = (!samples.array().isNaN() && !trusted).rowwise().any();
    const auto off = (samples - result.motion.middleCols<3>(3 * j)).rowwise().norm();
    displaced.col(j) = rejected.col(j).select(off, 0) / std::max(bones.noise(j), 1e-300);
  }
  return turning_in_noise(rejected, bones, displaced);
}

// Solves the windows of takes, in stacks of those alike, and tells the progress of all.
class Solving {
 public:
  Solving(std::span<const MovingPart> parts, std::span<const Prepared> prepared, Rejection reject,
          Backend& backend, int jobs, const Monitor& monitor)
      : parts_(parts),
        prepared_(prepared),
        reject_(reject),
        backend_(backend),
        jobs_(jobs),
        monitor_(monitor) {}

  // Puts the results of some takes in their places.
  void solve(std::span<const std::size_t> some, std::vector<Denoised>& results) {
    for (const std::size_t t : some)
      progress_.total += static_cast<Index>(prepared_[t].spans.size());
    for (Stack& stacked : stacks_of_alike(parts_, some, reject_)) solve(stacked, results);
  }

 private:
  void solve(Stack& stacked, std::vector<Denoised>& results) {
    const SegmentBatch data = stack(prepared_, stacked);
    const Solution solution =
        backend_.solve({data, stacked.priors}, stacked.method, part_of(monitor_, progress_));
    progress_.finished += data.segments();
    for_each_index(static_cast<Index>(stacked.takes.size()), jobs_, [&](Index i) {
      const std::size_t t = stacked.takes[static_cast<std::size_t>(i)];
      results[t] = result_of(parts_[t].clip, prepared_[t], solution,
                             stacked.first_segments[static_cast<std::size_t>(i)]);
    });
  }

  std::span<const MovingPart> parts_;
  std::span<const Prepared> prepared_;
  Rejection reject_;
  Backend& backend_;
  int jobs_;
  const Monitor& monitor_;
  Progress progress_;
};

// Confirms the motion that was rejected; returns the takes of which that is true of some.
std::vector<std::size_t> confirm_motion(std::span<const MovingPart> parts,
                                        std::span<const Denoised> results, int jobs,
                                        std::span<Prepared> prepared) {
  std::vector<char> found(parts.size());
  for_each_index(static_cast<Index>(parts.size()), jobs, [&](Index t) {
    const auto i = static_cast<std::size_t>(t);
    const Mask motion = rejected_motion(parts[i], prepared[i], results[i]);
    if (!motion.any()) return;
    Mask& confirmed = prepared[i].prior.confirmed;
    confirmed = confirmed || motion;
    found[i] = 1;
  });
  std::vector<std::size_t> some;
  for (std::size_t t = 0; t < found.size(); ++t)
    if (found[t]) some.push_back(t);
  return some;
}

// The result of a take of which nothing moves.
Denoised at_rest(const Recording& take) {
  const Matrix none(take.frames(), 0);
  return {.motion = none, .outliers = none, .sigma = none, .trusted = Mask(take.frames(), 0)};
}

}  // namespace

SegmentPlan plan(const Automatic& method, Index frames) {
  return segments_of_length(frames, method.window);
}

std::uint64_t copies_held(const Automatic&) { return copies_held(Segmentation{.overlap = 1}); }

void check(const Automatic& method) {
  if (method.window < shortest_window)
    throw ArgumentError(fmt::format("auto: window is {}, expected at least {} frames",
                                    method.window, shortest_window));
  if (method.overlap < 0)
    throw ArgumentError(
        fmt::format("auto: overlap is {}, expected at least 0 frames", method.overlap));
}

std::vector<Denoised> AutomaticDenoiser::denoise(std::span<const Recording> takes,
                                                 const Monitor& monitor) {
  check(method_);
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  require_usable(takes, true);
  const std::vector<MovingPart> parts = moving_parts(takes, method_, jobs_);
  std::vector<Prepared> prepared(takes.size());
  for_each_index(static_cast<Index>(takes.size()), jobs_, [&](Index t) {
    const auto i = static_cast<std::size_t>(t);
    prepared[i] = prepare(parts[i].clip, method_);
  });
  std::vector<Denoised> results(takes.size());
  std::vector<std::size_t> some(takes.size());
  std::iota(some.begin(), some.end(), 0);
  Solving solving(parts, prepared, method_.reject, backend_, jobs_, monitor);
  solving.solve(some, results);
  if (method_.reject == Rejection::automatic)
    solving.solve(confirm_motion(parts, results, jobs_, prepared), results);
  double frames = 0;
  for (const Prepared& one : prepared) frames += static_cast<double>(one.samples.rows());
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  for_each_index(static_cast<Index>(takes.size()), jobs_, [&](Index i) {
    const auto t = static_cast<std::size_t>(i);
    if (parts[t].columns.empty()) results[t] = at_rest(takes[t]);
    put_back(takes[t], parts[t], results[t]);
    leave_unobserved(takes[t], results[t]);
    if (method_.smooth == Smoothing::off)
      keep_observed(takes[t], trusted_samples(takes[t], results[t]), results[t]);
    results[t].solve_seconds = seconds * static_cast<double>(takes[t].frames()) / frames;
  });
  return results;
}

}  // namespace moclean
