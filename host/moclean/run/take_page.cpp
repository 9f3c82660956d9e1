#include "moclean/run/take_page.hpp"

#include <utility>

#include <fmt/format.h>

#include "moclean/core/version.hpp"
#include "moclean/linalg/precision.hpp"

namespace moclean {
namespace {

std::string frames_text(const FrameRange& range) {
  const auto text = [](const std::optional<Index>& frame) {
    return frame ? std::to_string(*frame) : std::string();
  };
  return text(range.first) + ":" + text(range.last);
}

std::string segmentation_text(const Segmentation& segmentation) {
  if (segmentation.whole) return "the whole take";
  const char* how = segmentation.cheapest ? "automatic" : "equal";
  const std::string text =
      segmentation.segments > 0
          ? fmt::format("{} {} segments", segmentation.segments, how)
          : fmt::format("{} segments of about {} frames", how, segmentation.length);
  if (segmentation.overlap == 0) return text;
  return text + fmt::format(", {} frames shared by neighbours", segmentation.overlap);
}

std::string lambda_text(const RobustPca& method) {
  if (method.lambda > 0) return fmt::format("{}", method.lambda);
  return fmt::format("{} / sqrt(max(frames, columns))", method.lambda_scale);
}

}  // namespace

std::vector<int> parents_of(const Recording& noisy, const Recording* truth) {
  std::vector<int> parents = joint_parents(noisy);
  if (parents.empty() && truth && truth->skeleton) return joint_parents(*truth->skeleton, noisy);
  return parents;
}

Report take_page(const Job& job, const Backend& backend, const TakeReport& take, ReportTake parts) {
  Report report{.title = take.file.filename().string(), .take = std::move(parts)};
  const auto add = [&](const char* name, std::string value) {
    report.parameters.emplace_back(name, std::move(value));
  };
  add("input", take.file.string());
  if (take.truth) add("truth", take.truth->file.string());
  if (job.reading.frames.first || job.reading.frames.last)
    add("frames", frames_text(job.reading.frames));
  if (job.truth_frames) add("frames of the truth", frames_text(*job.truth_frames));
  add("method", to_string(job.chain));
  if (const LowRank* step = first_low_rank(job.chain)) {
    add("segmentation", segmentation_text(step->segmentation));
    if (const auto* method = std::get_if<RobustPca>(&step->method)) {
      add("lambda", lambda_text(*method));
      add("rho", fmt::format("{}", method->rho));
      add("tolerance", fmt::format("{}", method->tolerance));
      add("most iterations", fmt::format("{}", method->max_iterations));
      add("order", to_string(method->order));
    }
  }
  add("computed on", backend.name());
  add("precision", to_string(backend.traits().mixed ? Precision::mixed : Precision::f64));
  add("seconds to solve", fmt::format("{:.3f}", take.solve_seconds));
  add("moclean", std::string(version()));
  return report;
}

}  // namespace moclean
