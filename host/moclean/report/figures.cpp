#include "moclean/report/figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/denoise/sample_status.hpp"
#include "moclean/metric/metric.hpp"

namespace moclean {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_worst_frames = 5;

// Mean square of the entries that are observed.
struct MeanSquare {
  double squares = 0;
  Index count = 0;

  void add(double value) {
    if (std::isnan(value)) return;
    squares += value * value;
    ++count;
  }
  double root() const { return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0; }
  double root_or_nan() const { return count > 0 ? root() : nan; }
};

template <class Matrix>
MeanSquare mean_square(const Matrix& matrix) {
  MeanSquare sum;
  for (Index r = 0; r < matrix.rows(); ++r)
    for (Index c = 0; c < matrix.cols(); ++c) sum.add(matrix(r, c));
  return sum;
}

void require_shape(const Recording& clip, const Recording& noisy, const char* what) {
  if (clip.samples.rows() == noisy.samples.rows() && clip.samples.cols() == noisy.samples.cols())
    return;
  throw ShapeError(fmt::format(
      "the {} of a report is {} frames x {} columns, the noisy take {} x {}", what,
      clip.samples.rows(), clip.samples.cols(), noisy.samples.rows(), noisy.samples.cols()));
}

void require_shapes(const ReportTake& take) {
  const Recording& noisy = take.noisy;
  if (noisy.samples.size() == 0) throw ShapeError("the take of a report is empty");
  if (static_cast<Index>(noisy.columns.size()) != noisy.samples.cols())
    throw ShapeError(fmt::format("the take of a report names {} columns but has {}",
                                 noisy.columns.size(), noisy.samples.cols()));
  require_shape(take.clean, noisy, "clean take");
  require_shape(take.outliers, noisy, "outliers");
  if (take.truth) require_shape(*take.truth, noisy, "truth");
  if (take.status) require_shape(like(noisy, *take.status), noisy, "status");
  if (take.sigma) require_shape(like(noisy, *take.sigma), noisy, "sigma");
}

// Second differences x[f] - 2 x[f + 1] + x[f + 2].
double roughness(const Matrix& samples) {
  const Index rows = samples.rows() - 2;
  if (rows < 1) return 0;
  return mean_square(samples.topRows(rows) - 2 * samples.middleRows(1, rows) +
                     samples.bottomRows(rows))
      .root();
}

void count_corrections(const ReportTake& take, ReportFigures& result) {
  const MeanSquare all = mean_square(take.outliers.samples);
  result.rms_correction = all.root();
  result.threshold = take.status ? 0 : result.rms_correction / 10;
  result.observed = all.count;
  const Mask corrected = corrected_entries(take, result.threshold);
  result.corrected = corrected.count();
  result.corrected_frames = corrected.rowwise().any().count();
  const Mask was_missing = take.noisy.samples.array().isNaN();
  const Mask is_missing = take.clean.samples.array().isNaN();
  result.filled = (was_missing && !is_missing).count();
  result.left = is_missing.count();
}

void per_frame(const ReportTake& take, ReportFigures& result) {
  result.per_frame.resize(take.noisy.frames(), take.truth ? 3 : 1);
  for (Index f = 0; f < take.noisy.frames(); ++f) {
    result.per_frame(f, 0) = mean_square(take.outliers.samples.row(f)).root_or_nan();
    if (!take.truth) continue;
    const auto truth = take.truth->samples.row(f);
    result.per_frame(f, 1) = mean_square(take.noisy.samples.row(f) - truth).root_or_nan();
    result.per_frame(f, 2) = mean_square(take.clean.samples.row(f) - truth).root_or_nan();
    result.nearer_frames += result.per_frame(f, 2) < result.per_frame(f, 1);
  }
}

void per_joint(const ReportTake& take, ReportFigures& result) {
  for (const Joint& joint : joints(take.noisy)) {
    const auto of = [&](const Matrix& samples) {
      return samples.middleCols(joint.first_column, joint.columns);
    };
    ReportFigures::JointFigure figure{joint.name, mean_square(of(take.outliers.samples)).root(),
                                      std::nullopt};
    if (take.truth) {
      const auto truth = of(take.truth->samples);
      figure.error = {.noisy = mean_square(of(take.noisy.samples) - truth).root(),
                      .clean = mean_square(of(take.clean.samples) - truth).root()};
      result.nearer_joints += figure.error->clean < figure.error->noisy;
    }
    result.joints.push_back(std::move(figure));
  }
}

// A frame and the joint of it from which most was taken away.
ReportFigures::WorstFrame most_corrected(const Matrix& corrections, Index frame) {
  ReportFigures::WorstFrame worst{.frame = frame};
  for (Index j = 0; j < corrections.cols(); ++j)
    if (corrections(frame, j) > worst.correction) {
      worst.joint = j;
      worst.correction = corrections(frame, j);
    }
  return worst;
}

// Worst first, and no two within a quarter of a second of each other. Cleaning can spoil a frame
// that was good, so that the larger error, before or after, counts; without truth, the correction.
std::vector<ReportFigures::WorstFrame> worst_frames(const ReportTake& take, const Matrix& series) {
  const auto badness = [&](Index f) {
    return take.truth ? std::max(series(f, 1), series(f, 2)) : series(f, 0);
  };
  const Matrix corrections = joint_corrections(take.outliers);
  const Index apart = std::max<Index>(10, static_cast<Index>(take.noisy.frame_rate / 4));
  std::vector<Index> order(static_cast<std::size_t>(series.rows()));
  std::iota(order.begin(), order.end(), Index{0});
  std::erase_if(order, [&](Index f) { return !(badness(f) > 0); });
  std::ranges::stable_sort(order, std::ranges::greater{}, badness);

  std::vector<ReportFigures::WorstFrame> found;
  for (const Index f : order) {
    if (found.size() == most_worst_frames) break;
    if (std::ranges::any_of(found,
                            [&](const auto& other) { return std::abs(other.frame - f) < apart; }))
      continue;
    found.push_back(most_corrected(corrections, f));
  }
  return found;
}

// The frame that came nearest to the truth by the way it went; the worst one where there is none.
ReportFigures::WorstFrame opening(const ReportTake& take, const ReportFigures& found) {
  const ReportFigures::WorstFrame nothing{.frame = -1};
  if (!take.truth) return found.worst_frames.empty() ? nothing : found.worst_frames.front();
  double most = 0;
  Index best = -1;
  for (Index f = 0; f < found.per_frame.rows(); ++f) {
    const double gained = found.per_frame(f, 1) - found.per_frame(f, 2);
    if (!(gained > most)) continue;
    most = gained;
    best = f;
  }
  return best < 0 ? nothing : most_corrected(joint_corrections(take.outliers), best);
}

// What the roughness before and after tells.
std::string smoothness(double noisy, double clean) {
  constexpr double noticeable = 1.05;
  if (clean == 0) return noisy > 0 ? "smooth now" : "as smooth as before";
  if (noisy / clean >= noticeable) return fmt::format("{:.1f} times smoother", noisy / clean);
  return clean / noisy >= noticeable ? fmt::format("{:.1f} times rougher", clean / noisy)
                                     : "as smooth as before";
}

}  // namespace

Mask corrected_entries(const ReportTake& take, double threshold) {
  if (!take.status) return take.outliers.samples.array().abs() > threshold;
  return take.status->array() == static_cast<double>(SampleStatus::corrected);
}

Matrix joint_corrections(const Recording& outliers) {
  const std::vector<Joint> all = joints(outliers);
  Matrix corrections(outliers.frames(), static_cast<Index>(all.size()));
  for (Index f = 0; f < outliers.frames(); ++f)
    for (std::size_t j = 0; j < all.size(); ++j) {
      const MeanSquare entries =
          mean_square(outliers.samples.row(f).segment(all[j].first_column, all[j].columns));
      corrections(f, static_cast<Index>(j)) = entries.count > 0 ? std::sqrt(entries.squares) : nan;
    }
  return corrections;
}

ReportFigures figures(const ReportTake& take) {
  require_shapes(take);
  ReportFigures result;
  count_corrections(take, result);
  if (take.truth)
    result.fd = {.noisy = frobenius_distance(take.truth->samples, take.noisy.samples),
                 .clean = frobenius_distance(take.truth->samples, take.clean.samples)};
  result.roughness = {.noisy = roughness(take.noisy.samples),
                      .clean = roughness(take.clean.samples)};
  per_frame(take, result);
  per_joint(take, result);
  result.worst_frames = worst_frames(take, result.per_frame);
  result.opening = opening(take, result);
  return result;
}

std::string verdict(const ReportTake& take, const ReportFigures& figures) {
  if (!take.truth) {
    const auto& [noisy, clean] = figures.roughness;
    return fmt::format(
        "{:.1f} % of the entries were corrected; from frame to frame the take is {}. Only a truth "
        "(--truth) can tell whether it is nearer to the motion.",
        100 * static_cast<double>(figures.corrected) /
            static_cast<double>(std::max<Index>(1, figures.observed)),
        smoothness(noisy, clean));
  }
  const auto& [noisy, clean] = *figures.fd;
  if (clean == noisy) return "The take is as far from the truth as before.";
  if (clean > noisy)
    return noisy == 0 ? "The take got worse: it was the truth before cleaning."
                      : fmt::format("The take got worse: {:.2f} times as far from the truth.",
                                    clean / noisy);
  if (clean == 0) return "The take got better: it is the truth now.";
  return fmt::format("The take got better: {:.1f} times nearer to the truth.", noisy / clean);
}

}  // namespace moclean
