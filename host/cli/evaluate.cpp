#include <algorithm>
#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/io/read_write.hpp"
#include "moclean/metric/metric.hpp"

#include "cli/commands.hpp"
#include "cli/inputs.hpp"
#include "cli/json_record.hpp"

namespace moclean::cli {
namespace {

struct EvaluateOptions {
  std::filesystem::path truth;
  std::filesystem::path estimate;
  InputOptions reading;
  bool json = false;
};

Json comparison_record(const Comparison& comparison, const Clip& truth) {
  Json record;
  record["fd"] = comparison.fd;
  record["rmse_changed"] = comparison.rmse_changed;
  record["changed"] = comparison.changed;
  record["largest"] = comparison.largest;
  record["worst_joint"] = comparison.worst_joint;
  record["not_compared"] = comparison.not_compared;
  record["frames"] = truth.frames();
  record["columns"] = truth.samples.cols();
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

void print_comparison(const Comparison& comparison, const Clip& truth) {
  const std::string unit = truth.unit.empty() ? "" : " " + truth.unit;
  fmt::print("compared         {} frames x {} columns\n", truth.frames(), truth.samples.cols());
  if (comparison.not_compared > 0)
    fmt::print("not compared     {} entries that are missing in either\n", comparison.not_compared);
  fmt::print("FD               {:.6g}{}\n", comparison.fd, unit);
  fmt::print("entries changed  {}, RMSE over them {:.6g}{}\n", comparison.changed,
             comparison.rmse_changed, unit);
  fmt::print("largest error    {:.6g}{}\n", comparison.largest, unit);
  fmt::print("worst joint      {}\n\n",
             comparison.worst_joint.empty() ? "none, they are equal" : comparison.worst_joint);

  std::size_t width = 5;
  for (const auto& joint : comparison.joints) width = std::max(width, joint.name.size());
  fmt::print("{:<{}}  {:>12}  {:>12}  {:>8}\n", "joint", width, "RMSE", "largest", "at frame");
  for (const auto& joint : comparison.joints)
    fmt::print("{:<{}}  {:>12.6g}  {:>12.6g}  {:>8}\n", joint.name, width, joint.rmse,
               joint.largest, joint.largest_frame);
}

ExitCode run(const EvaluateOptions& options) {
  InputOptions whole = options.reading;
  whole.frames = {};
  Clip truth = read_input(options.truth, whole);
  Clip estimate = read_input(options.estimate, whole);
  const FrameRange& frames = options.reading.frames;
  if (frames.first || frames.last) {
    if (estimate.frames() == truth.frames())
      estimate = select_frames(estimate, frames, options.estimate);
    truth = select_frames(truth, frames, options.truth);
  }

  const Comparison comparison = compare(truth, estimate);
  if (options.json)
    fmt::print("{}", to_text(comparison_record(comparison, truth)));
  else
    print_comparison(comparison, truth);
  return ExitCode::done;
}

}  // namespace

void add_evaluate(CLI::App& program, Action& action) {
  CLI::App& command =
      *program.add_subcommand("evaluate", "Measure how far an estimate is from the truth");
  command.footer(
      "FD is |TRUTH - ESTIMATE|_F / sqrt(frames x columns) (Peng et al., equation 8). --frames "
      "cuts\n"
      "TRUTH, and ESTIMATE too if both files are equally long.\n\n"
      "Example:\n"
      "  moclean evaluate walk.bvh clean.csv\n"
      "  moclean evaluate 14_06.amc clean.npy --frames 0:2800 --json");
  const auto options = std::make_shared<EvaluateOptions>();
  command.add_option("TRUTH", options->truth, "Recording without noise")->required()->type_name("");
  command.add_option("ESTIMATE", options->estimate, "Recording of the same shape")
      ->required()
      ->type_name("");
  add_input_options(command, options->reading);
  command.add_flag("--json", options->json, "Print the figures as JSON");
  command.callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace moclean::cli
