#include "cli/commands/denoise_report.hpp"

#include <utility>

#include <fmt/format.h>

#include "moclean/formats/read_skeleton.hpp"

namespace moclean::cli {
namespace {

std::string frames_text(const FrameRange& range) {
  const auto text = [](const std::optional<Index>& frame) {
    return frame ? std::to_string(*frame) : std::string();
  };
  return text(range.first) + ":" + text(range.last);
}

std::string segmentation_text(const Segmentation& segmentation) {
  if (segmentation.whole) return "the whole take";
  const char* how = segmentation.automatic ? "automatic" : "equal";
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

std::vector<int> parents_of(const Job& job, std::size_t take, const Clip& noisy) {
  const ReadOptions reading{.skeleton = job.options.reading.skeleton, .rate = 0};
  std::vector<std::filesystem::path> files = {job.files[take]};
  if (!job.truths.empty()) files.push_back(job.truths[take]);
  for (const std::filesystem::path& file : files) {
    const std::optional<Skeleton> skeleton = read_skeleton(file, reading);
    if (!skeleton) continue;
    std::vector<int> parents = joint_parents(*skeleton, noisy);
    if (!parents.empty()) return parents;
  }
  return {};
}

Report denoise_report(const Job& job, const TakeReport& take, ReportTake parts) {
  const DenoiseOptions& options = job.options;
  Report report{.title = take.file.filename().string(), .take = std::move(parts)};
  const auto add = [&](const char* name, std::string value) {
    report.parameters.emplace_back(name, std::move(value));
  };
  add("input", take.file.string());
  if (take.truth) add("truth", take.truth->file.string());
  if (options.reading.frames.first || options.reading.frames.last)
    add("frames", frames_text(options.reading.frames));
  if (options.truth_frames) add("frames of the truth", frames_text(*options.truth_frames));
  add("method", to_string(options.chain));
  if (const LowRank* step = first_low_rank(options.chain)) {
    add("segmentation", segmentation_text(step->segmentation));
    if (const auto* method = std::get_if<RobustPca>(&step->method)) {
      add("lambda", lambda_text(*method));
      add("rho", fmt::format("{}", method->rho));
      add("tolerance", fmt::format("{}", method->tolerance));
      add("most iterations", fmt::format("{}", method->max_iterations));
      add("order", to_string(method->order));
    }
  }
  add("computed on", job.backend);
  add("precision", to_string(options.precision));
  add("seconds to solve", fmt::format("{:.3f}", take.solve_seconds));
  add("moclean", MOCLEAN_VERSION);
  return report;
}

}  // namespace moclean::cli
