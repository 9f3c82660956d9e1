#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "moclean/denoise/chain.hpp"
#include "moclean/report/report.hpp"
#include "moclean/run/engine.hpp"
#include "moclean/run/outputs.hpp"
#include "moclean/run/process_memory.hpp"
#include "moclean/run/truth.hpp"

#include "cli/backend/open_backend.hpp"
#include "cli/commands/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/options/denoise_options.hpp"
#include "cli/printing/backend_report.hpp"
#include "cli/printing/json_record.hpp"
#include "cli/printing/progress_line.hpp"

namespace moclean::cli {
namespace {

namespace fs = std::filesystem;

ProfileReport profile_of(const Device& device, const DenoiseOptions& options,
                         double solve_seconds) {
  auto kernels = device.profile()->kernels();  // before those that measure the peak
  const double busy_seconds = device.profile()->busy_seconds();
  return {.kernels = std::move(kernels),
          .busy_seconds = busy_seconds,
          .peak = measure_peak(device),
          .solve_seconds = solve_seconds,
          .precision = options.precision};
}

// `7`, or `5-9` if the segments differ.
template <class Value>
std::string range(const std::vector<DenoisedSegment>& segments, const Value& value) {
  const auto [least, most] = std::ranges::minmax(segments, {}, value);
  return value(least) == value(most) ? fmt::format("{}", value(least))
                                     : fmt::format("{}-{}", value(least), value(most));
}

// What the segments say; nothing for filters.
std::string segments_text(const std::vector<DenoisedSegment>& segments) {
  if (segments.empty()) return "";
  const auto iterations = [](const DenoisedSegment& s) { return s.outcome.iterations; };
  const auto rank = [](const DenoisedSegment& s) { return s.outcome.rank.value_or(0); };
  const bool has_rank = std::ranges::all_of(
      segments, [](const DenoisedSegment& s) { return s.outcome.rank.has_value(); });
  return fmt::format(" segments {}, iterations {},{}", segments.size(), range(segments, iterations),
                     has_rank ? fmt::format(" rank {},", range(segments, rank)) : "");
}

void print_summary(const TakeReport& take, const fs::path& result) {
  fmt::print("{} -> {}: {} frames x {} columns,{} {:.3f} s, {:.0f} frames/s\n", take.file.string(),
             result.string(), take.frames, take.columns, segments_text(take.segments),
             take.solve_seconds, take.frames_per_second());
  if (take.truth)
    fmt::print("{}: FD from the truth {:.4g} -> {:.4g}\n", take.file.string(), take.truth->fd_noisy,
               take.truth->fd_clean);
  if (take.verification) fmt::print("{}\n", agreement_line(take));
}

void print_report(const RunReport& run, const OutputPlan& plan, const BackendReport& backend) {
  for (std::size_t i = 0; i < run.takes.size(); ++i) print_summary(run.takes[i], plan.clean[i]);
  if (backend.profile) fmt::print("\n{}", profile_table(*backend.profile));
}

void tell_notes(const std::vector<TakeReport>& takes) {
  for (const TakeReport& take : takes)
    for (const std::string& line : note_lines(take.file, take.notes))
      fmt::print(stderr, "moclean: {}\n", line);
}

void warn_of_unobserved(const std::vector<TakeReport>& takes) {
  for (const TakeReport& take : takes)
    if (!take.unobserved.empty()) fmt::print(stderr, "moclean: {}\n", unobserved_line(take));
}

void tell_of_changes(const std::vector<TakeReport>& takes) {
  for (const TakeReport& take : takes)
    if (is_changed_much(take)) fmt::print(stderr, "moclean: {}\n", changed_line(take));
}

ExitCode warn_if_not_converged(const std::vector<TakeReport>& takes) {
  ExitCode code = ExitCode::done;
  for (const TakeReport& take : takes) {
    const auto failed = std::ranges::count_if(
        take.segments, [](const DenoisedSegment& s) { return fell_short(s.outcome); });
    if (failed == 0) continue;
    fmt::print(stderr,
               "moclean: {}: {} of {} segments did not converge; raise --max-iterations or "
               "--tolerance\n",
               take.file.string(), failed, take.segments.size());
    code = ExitCode::not_converged;
  }
  return code;
}

// The lines of progress of a run.
class RunProgress {
 public:
  explicit RunProgress(const DenoiseOptions& options) : solving_("solving", !options.quiet) {
    if (options.verify) verifying_.emplace("verifying", !options.quiet);
  }

  void operator()(const RunEvent& event) {
    const auto* solved = std::get_if<SegmentsSolved>(&event);
    if (!solved) return;
    ProgressLine& line = solved->task == SolveTask::verifying ? *verifying_ : solving_;
    line.show(solved->progress,
              solved->total_is_exact ? ProgressTotal::exact : ProgressTotal::estimated);
  }

 private:
  ProgressLine solving_;
  std::optional<ProgressLine> verifying_;
};

Job job_of(const DenoiseOptions& options) {
  Job job{.files = expand_folders(options.inputs),
          .reading = options.reading,
          .truth_frames = options.truth_frames,
          .from_rotations = options.from_rotations,
          .chain = options.chain,
          .max_gap = options.max_gap,
          .keep_observed = options.keep_observed,
          .verify = options.verify,
          .jobs = options.jobs,
          .memory_limit = options.memory_limit,
          .overlap = options.overlap};
  job.outputs = plan_outputs({.inputs = options.inputs,
                              .files = job.files,
                              .output = options.output,
                              .outliers = options.outliers,
                              .mask = options.mask,
                              .sigma = options.sigma,
                              .report = options.report,
                              .format = options.format});
  if (!options.truth.empty()) job.truths = truths_of(options.truth, job.files);
  return job;
}

RunReport run_shown(const Job& job, const DenoiseOptions& options, Backend& backend,
                    const std::stop_token& stop) {
  RunProgress progress(options);
  return run_job(job, backend, std::ref(progress), stop);
}

ExitCode run(DenoiseOptions options) {
  if (options.memory_limit != 0) return_freed_memory();  // whoever sets a limit means it
  complete(options);
  const Interrupt interrupt;  // before the threads of the OpenCL driver
  if (!options.report.empty()) require_report();
  const Job job = job_of(options);
  if (!options.json.empty() && options.json != "-") require_writable(options.json);

  OpenedBackend opened = open_backend(options, needs_backend(options.chain),
                                      options.profile ? Profiling::on : Profiling::off);
  const RunReport report = run_shown(job, options, *opened.backend, interrupt.token());

  if (options.profile)
    opened.report.profile = profile_of(*opened.device, options, report.seconds.solve);
  if (!options.json.empty()) write_json(options.json, json_record(options, opened.report, report));
  if (options.reports()) print_report(report, job.outputs, opened.report);
  tell_notes(report.takes);
  warn_of_unobserved(report.takes);
  tell_of_changes(report.takes);
  return warn_if_not_converged(report.takes);
}

// The names joined by spaces, a line at a time.
std::string lines_of(std::span<const std::string_view> names) {
  constexpr std::size_t width = 76;
  std::string text, line;
  for (const std::string_view name : names) {
    if (!line.empty() && line.size() + 1 + name.size() > width) {
      text += line + '\n';
      line.clear();
    }
    line += (line.empty() ? "" : " ") + std::string(name);
  }
  return text + line;
}

}  // namespace

void add_denoise(CLI::App& program, Action& action) {
  CLI::App& command = *program.add_subcommand("denoise", "Clean recordings");
  command.footer(
      "Several recordings are solved together and give the same files as single calls. The next\n"
      "ones are read and the last ones written while the device works. If one cannot be read,\n"
      "nothing is written for any; Ctrl-C leaves nothing: results wait under temporary names.\n"
      "Exit codes: 0 done, 1 failed input or device (or --verify), 2 usage, 3 written, but a\n"
      "segment did not converge, 130 interrupted.\n\n"
      "The bounds of --verify hold for the default tolerance and are the same for any other;\n"
      "--precision mixed has its own.\n\n"
      "A chain of filters only runs on the host, where missing samples stay missing; slra, rpca,\n"
      "completion, tslra and interpolate fill them. Steps:\n" +
      lines_of(step_names()) +
      ";\n"
      "docs/methods.md has their keys.\n\n"
      "Example:\n"
      "  moclean denoise walk.bvh -o clean.csv --segment-length 200 --verify\n"
      "  moclean denoise walk.bvh -o clean.csv --method "
      "hampel:window=7,sigmas=3+butterworth:cutoff=10\n"
      "  moclean denoise takes/ -o cleaned/ --json cleaned.json");
  const auto options = std::make_shared<DenoiseOptions>();
  add_denoise_options(command, *options);
  command.callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace moclean::cli
