#include <algorithm>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/formats.hpp"
#include "moclean/formats/read_write.hpp"
#include "moclean/metric/figures.hpp"
#include "moclean/metric/metric.hpp"
#include "moclean/run/inputs.hpp"

#include "cli/commands/commands.hpp"
#include "cli/options/checks.hpp"
#include "cli/options/input_options.hpp"
#include "cli/printing/json_record.hpp"
#include "cli/printing/say.hpp"

namespace moclean::cli {
namespace {

struct EvaluateOptions {
  std::filesystem::path truth;
  std::filesystem::path estimate;
  std::filesystem::path mask;      // empty: not given
  std::filesystem::path outliers;  // empty: not given
  double threshold = 0;
  ReadOptions reading;
  bool json = false;
};

// A figure of an evaluation; NaN where there is nothing to measure.
struct Value {
  const Figure& figure;
  double value;
};

Json comparison_record(const Comparison& comparison, const Recording& truth,
                       const std::vector<Value>& values) {
  Json record;
  record["fd"] = comparison.fd;
  record["rmse_changed"] = comparison.rmse_changed;
  record["changed"] = comparison.changed;
  record["largest"] = comparison.largest;
  record["worst_joint"] = comparison.worst_joint;
  record["not_compared"] = comparison.not_compared;
  record["frames"] = truth.frames();
  record["columns"] = truth.samples.cols();
  for (const auto& [figure, value] : values) record["figures"][std::string(figure.name)] = value;
  record["joints"] = Json::array();
  for (const Comparison::JointError& joint : comparison.joints) {
    Json entry;
    entry["name"] = joint.name;
    entry["rmse"] = joint.rmse;
    entry["largest"] = joint.largest;
    entry["largest_frame"] = joint.largest_frame;
    record["joints"].push_back(std::move(entry));
  }
  return record;
}

// `length/frame^2` with the unit of the clip for length.
std::string unit_of(const Figure& figure, const Recording& truth) {
  std::string unit(figure.unit);
  const std::size_t length = unit.find("length");
  if (length == unit.npos) return unit;
  unit.replace(length, 6, truth.unit.empty() ? "" : truth.unit);
  return unit.starts_with("/") ? "1" + unit : unit;
}

void print_figures(const std::vector<Value>& values, const Recording& truth) {
  for (const auto& [figure, value] : values)
    say("{:<16} {:<12.6g} {:<12} {}\n", figure.name, value, unit_of(figure, truth),
        figure.description);
  say("\n");
}

void print_comparison(const Comparison& comparison, const Recording& truth,
                      const std::vector<Value>& values) {
  const std::string unit = truth.unit.empty() ? "" : " " + truth.unit;
  say("compared         {} frames x {} columns\n", truth.frames(), truth.samples.cols());
  if (comparison.not_compared > 0)
    say("not compared     {} entries that are missing in either\n", comparison.not_compared);
  say("FD               {:.6g}{}\n", comparison.fd, unit);
  say("entries changed  {}, RMSE over them {:.6g}{}\n", comparison.changed, comparison.rmse_changed,
      unit);
  say("largest error    {:.6g}{}\n", comparison.largest, unit);
  say("worst joint      {}\n\n",
      comparison.worst_joint.empty() ? "none, they are equal" : comparison.worst_joint);
  print_figures(values, truth);

  std::size_t width = 5;
  for (const auto& joint : comparison.joints) width = std::max(width, joint.name.size());
  say("{:<{}}  {:>12}  {:>12}  {:>8}\n", "joint", width, "RMSE", "largest", "at frame");
  for (const auto& joint : comparison.joints)
    say("{:<{}}  {:>12.6g}  {:>12.6g}  {:>8}\n", joint.name, width, joint.rmse, joint.largest,
        joint.largest_frame);
}

// The frames that --frames asks for. It counts in the truth; a file as long as the truth is cut
// alike.
Recording select(const Recording& clip, Index frames_of_truth, const FrameRange& frames,
                 const std::filesystem::path& file) {
  if (!frames.first && !frames.last) return clip;
  return clip.frames() == frames_of_truth ? select_frames(clip, frames, file) : clip;
}

std::vector<Value> measured(const Evaluation& evaluation) {
  const std::vector<int> parents = joint_parents(evaluation.truth);
  Evaluation complete = evaluation;
  complete.parents = parents;
  std::vector<Value> values;
  for (const Figure& figure : figures())
    if (const auto value = figure.of(complete)) values.push_back({figure, *value});
  return values;
}

ExitCode run(const EvaluateOptions& options) {
  ReadOptions whole = options.reading;
  whole.frames = {};
  const Recording all = read_recording(options.truth, whole);
  const auto read = [&](const std::filesystem::path& file) {
    return select(read_recording(file, whole), all.frames(), options.reading.frames, file);
  };
  const Recording truth = select(all, all.frames(), options.reading.frames, options.truth);
  const Recording estimate = read(options.estimate);
  const Comparison comparison = compare(truth, estimate);

  Evaluation evaluation{truth, estimate};
  evaluation.outlier_threshold = options.threshold;
  Mask touched;
  Matrix outliers;
  if (!options.mask.empty()) touched = read(options.mask).samples.array() != 0;
  if (!options.outliers.empty()) outliers = read(options.outliers).samples;
  if (!options.mask.empty()) evaluation.touched = &touched;
  if (!options.outliers.empty()) evaluation.outliers = &outliers;
  const std::vector<Value> values = measured(evaluation);

  if (options.json)
    write_output(to_text(comparison_record(comparison, truth, values)));
  else
    print_comparison(comparison, truth, values);
  return ExitCode::done;
}

}  // namespace

void add_evaluate(CLI::App& program, Action& action) {
  CLI::App& command =
      *program.add_subcommand("evaluate", "Measure how far an estimate is from the truth");
  command.footer(
      "FD is |TRUTH - ESTIMATE|_F / sqrt(frames x columns) (Peng et al., equation 8); "
      "docs/metrics.md\n"
      "has every figure. --frames counts in TRUTH; other files are cut alike if they are as long.\n"
      "Bone lengths need a skeleton: a TRUTH in " +
      any_extension(has_skeleton) +
      ", or --skeleton.\n\n"
      "Example:\n"
      "  moclean evaluate walk.bvh clean.csv\n"
      "  moclean evaluate walk.bvh clean.csv --mask touched.csv --outliers outliers.csv\n"
      "  moclean evaluate 14_06.amc clean.npy --frames 0:2800 --json");
  const auto options = std::make_shared<EvaluateOptions>();
  command.add_option("TRUTH", options->truth, "Recording without noise")->required()->type_name("");
  command.add_option("ESTIMATE", options->estimate, "Recording of the same shape")
      ->required()
      ->type_name("");
  add_input_options(command, options->reading);
  auto* mask =
      command
          .add_option("--mask", options->mask, "What noise touched, not 0 there (corrupt --mask)")
          ->type_name("FILE");
  auto* outliers = command
                       .add_option("--outliers", options->outliers,
                                   "What was taken away (denoise --outliers), to see how much of "
                                   "the mask was found")
                       ->needs(mask)
                       ->type_name("FILE");
  command.add_option("--threshold", options->threshold, "Outliers count as found above this size")
      ->needs(outliers)
      ->check(number_from_zero())
      ->capture_default_str()
      ->type_name("X");
  command.add_flag("--json", options->json, "Print the figures as JSON");
  command.callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace moclean::cli
