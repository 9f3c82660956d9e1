#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/denoise/chain.hpp"
#include "moclean/formats/temporary_name.hpp"
#include "moclean/report/report.hpp"
#include "moclean/run/process_memory.hpp"
#include "moclean/run/result_writer.hpp"
#include "moclean/run/same_file.hpp"

#include "cli/backend/driver_check.hpp"
#include "cli/backend/first_use.hpp"
#include "cli/backend/open_backend.hpp"
#include "cli/batch/batch_plan.hpp"
#include "cli/batch/batch_run.hpp"
#include "cli/batch/standard_streams.hpp"
#include "cli/commands/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/options/layers.hpp"
#include "cli/printing/backend_report.hpp"
#include "cli/printing/json_record.hpp"
#include "cli/printing/progress_line.hpp"
#include "cli/printing/say.hpp"
#include "cli/printing/take_lines.hpp"
#include "cli/printing/take_text.hpp"

namespace moclean::cli {
namespace {

namespace fs = std::filesystem;

// An interrupt after which something is written.
class Stopped : public Error {
 public:
  using Error::Error;
};

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

// Measured when all is written: a device that fails then costs the profile, which is told.
ExitCode add_profile(OpenedBackend& opened, const DenoiseOptions& options, double solve_seconds) {
  if (!options.profile || !opened.device) return ExitCode::done;
  try {
    opened.report.profile = profile_of(*opened.device, options, solve_seconds);
    return ExitCode::done;
  } catch (const DeviceError& error) {
    warn("--profile: {}", error.what());
    return ExitCode::failed;
  }
}

void tell_notes(const std::vector<TakeReport>& takes) {
  for (const TakeReport& take : takes)
    for (const std::string& line : note_lines(take.file, take.notes)) warn("{}", line);
}

void warn_of_unobserved(const std::vector<TakeReport>& takes) {
  for (const TakeReport& take : takes)
    if (!take.unobserved.empty()) warn("{}", unobserved_line(take));
}

void tell_of_changes(const std::vector<TakeReport>& takes) {
  for (const TakeReport& take : takes)
    if (is_changed_much(take)) warn("{}", changed_line(take));
}

ExitCode warn_if_not_converged(const std::vector<TakeReport>& takes) {
  ExitCode code = ExitCode::done;
  for (const TakeReport& take : takes) {
    const auto failed = std::ranges::count_if(
        take.segments, [](const DenoisedSegment& s) { return fell_short(s.outcome); });
    if (failed == 0) continue;
    warn(
        "{}: {} of {} segments did not converge; raise --max-iterations or "
        "--tolerance",
        take.file.string(), failed, take.segments.size());
    code = ExitCode::not_converged;
  }
  return code;
}

// The lines of progress of a run.
class RunProgress {
 public:
  RunProgress(const DenoiseOptions& options, bool compiles)
      : solving_("solving", !options.quiet, "segments",
                 compiles ? "compiling kernels, first use on this device ..." : "") {
    if (options.verify) verifying_.emplace("verifying", !options.quiet);
  }

  void show(const SegmentsSolved& solved) {
    ProgressLine& line = solved.task == SolveTask::verifying ? *verifying_ : solving_;
    line.show(solved.progress,
              solved.total_is_exact ? ProgressTotal::exact : ProgressTotal::estimated);
  }

 private:
  ProgressLine solving_;
  std::optional<ProgressLine> verifying_;
};

// What a user may know of a take beside its report.
Json full_record(const BatchPlan& plan, const StandardStreams& streams, std::size_t take,
                 const TakeReport& report) {
  TakeReport shown = report;
  shown.file = streams.named(report.file.string());
  shown.failure = streams.named(report.failure);
  Json record = take_record(shown);
  record["method"] = to_string(plan.options_of(take).chain);
  if (!report.failure.empty()) return record;
  record["outputs"] = Json::array();
  for (const fs::path& file : results_of(plan.outputs, take))
    record["outputs"].push_back(streams.named(file.string()));
  return record;
}

Json left_out_record(const BatchPlan& plan, std::size_t take) {
  return {{"file", plan.files[take].string()}, {"left_out", "done before"}};
}

Json unreadable_record(const BatchPlan& plan, std::size_t folder) {
  return {{"folder", plan.passed_by.unreadable[folder].string()},
          {"error", plan.passed_by.problems[folder]}};
}

Json whole_record(const BatchPlan& plan, const BackendReport& backend, const RunReport& report) {
  Json record = json_record(plan.common(), backend, report);
  for (std::size_t i = 0; i < plan.files.size(); ++i) {
    if (plan.done[i]) record["inputs"][i] = left_out_record(plan, i);
    if (plan.setting_of[i] != 0)
      record["inputs"][i]["method"] = to_string(plan.options_of(i).chain);
  }
  for (std::size_t i = 0; i < plan.passed_by.problems.size(); ++i)
    record["unreadable_folders"].push_back(unreadable_record(plan, i));
  return record;
}

// The log of a build has lines; a name that has some is one.
void tell_failure(const TakeReport& take) {
  if (take.file.string().find('\n') == std::string::npos)
    warn("{}", Lines{take.failure});
  else
    warn("{}", take.failure);
}

// Everything about the takes that goes to standard error, the failures last, and the folders that
// were passed by.
ExitCode tell_problems(const RunReport& report, const std::vector<std::string>& unreadable) {
  std::vector<TakeReport> written, failed;
  for (const TakeReport& take : report.takes)
    (take.failure.empty() ? written : failed).push_back(take);
  tell_notes(written);
  warn_of_unobserved(written);
  tell_of_changes(written);
  const ExitCode code = warn_if_not_converged(written);
  for (const TakeReport& take : failed) tell_failure(take);
  for (const std::string& problem : unreadable) warn("{}", problem);
  if (!failed.empty()) warn("{} of {} takes failed, see above", failed.size(), report.takes.size());
  return failed.empty() && unreadable.empty() ? code : ExitCode::failed;
}

void print_report(const BatchPlan& plan, const StandardStreams& streams, const RunReport& run,
                  const BackendReport& backend) {
  for (std::size_t i = 0; i < run.takes.size(); ++i)
    if (!plan.done[i] && run.takes[i].failure.empty())
      say("{}", Lines{streams.named(take_text(run.takes[i], plan.outputs.clean[i]))});
  say("{}", Lines{run_text(run, plan.done)});
  if (backend.profile) say("\n{}", Lines{profile_table(*backend.profile)});
}

// What stands around the results of a run in a folder: the lock, the manifest, the folder itself.
class ResultsFolder {
 public:
  explicit ResultsFolder(const BatchPlan& plan)
      : folders_(plan.outputs.folders),
        lock_(plan.outputs.root.empty() ? plan.outputs.clean.front().parent_path() / "."
                                        : plan.outputs.root) {
    lock_.if_alone([&] {
      std::vector<fs::path> results;
      for (std::size_t i = 0; i < plan.files.size(); ++i)
        for (fs::path& file : results_of(plan.outputs, i)) results.push_back(std::move(file));
      if (!plan.outputs.root.empty()) results.push_back(plan.outputs.root / manifest_name);
      remove_left_of(results);
    });
    if (!plan.outputs.root.empty()) manifest_.emplace(plan.outputs.root);
  }

  Manifest* manifest() { return manifest_ ? &*manifest_ : nullptr; }

  void finish() {
    if (manifest_) lock_.if_alone([&] { manifest_->tidy(); });
  }

 private:
  NewFolders folders_;  // that stay empty are removed
  FolderLock lock_;
  std::optional<Manifest> manifest_;
};

RunReport run_shown(const BatchPlan& plan, const StandardStreams& streams, Manifest* manifest,
                    OpenedBackend& opened, TakeLines& lines) {
  const Interrupt interrupt;
  const FirstUse first_use(opened, plan.common());
  RunProgress progress(plan.common(), first_use.is_first());
  std::size_t written = 0;
  const auto sink = [&](const RunEvent& event) {
    if (const auto* solved = std::get_if<SegmentsSolved>(&event)) progress.show(*solved);
    if (const auto* done = std::get_if<TakeWritten>(&event)) {
      ++written;
      lines.add(full_record(plan, streams, done->take, *done->report));
    }
    if (const auto* failed = std::get_if<TakeFailed>(&event))
      lines.add(full_record(plan, streams, failed->take, *failed->report));
  };
  try {
    RunReport report = run_batch(plan, manifest, *opened.backend, sink, interrupt.token());
    first_use.keep();
    return report;
  } catch (const Cancelled&) {
    if (written == 0) throw;
    throw Stopped(fmt::format(
        "interrupted; {} of {} takes were written and stay, --resume goes on from there", written,
        plan.files.size() -
            static_cast<std::size_t>(std::ranges::count_if(plan.done, [](char d) { return d; }))));
  }
}

// Records must not replace what is read or written beside them.
void require_records_apart(const BatchPlan& plan) {
  const DenoiseOptions& options = plan.common();
  std::vector<NamedFile> others = {{"--config", options.config}};
  const auto add = [&](const char* option, const std::vector<fs::path>& files) {
    for (const fs::path& file : files) others.push_back({option, file});
  };
  add("INPUT", plan.files);
  add("--truth", plan.truths);
  for (const DenoiseOptions& setting : plan.settings)
    others.push_back({"--skeleton", setting.reading.skeleton});
  add("-o", plan.outputs.clean);
  add("--outliers", plan.outputs.outliers);
  add("--mask", plan.outputs.masks);
  add("--sigma", plan.outputs.sigmas);
  add("--report", plan.outputs.reports);
  for (const auto& copies : plan.outputs.copies)
    for (const FileCopy& copy : copies) {
      others.push_back({"INPUT", copy.from});
      others.push_back({"-o", copy.to});
    }
  if (!plan.outputs.root.empty()) others.push_back({"-o", plan.outputs.root / manifest_name});
  const NamedFile records[] = {{"--json", options.json}, {"--lines", options.lines}};
  require_apart(others, records);
}

bool runs_on_device(const BatchPlan& plan) {
  return std::ranges::any_of(plan.groups(), [&](const auto& takes) {
    return needs_backend(plan.options_of(takes.front()).chain);
  });
}

ExitCode run_planned(const BatchPlan& plan, const StandardStreams& streams) {
  const DenoiseOptions& options = plan.common();
  require_records_apart(plan);
  const bool on_device = runs_on_device(plan);
  if (on_device && options.backend == "opencl") require_driver();
  OpenedBackend opened =
      open_backend(options, on_device, options.profile ? Profiling::on : Profiling::off);
  ResultsFolder folder(plan);
  TakeLines lines(options.lines);
  for (std::size_t i = 0; i < plan.files.size(); ++i)
    if (plan.done[i]) lines.add(left_out_record(plan, i));
  for (std::size_t i = 0; i < plan.passed_by.problems.size(); ++i)
    lines.add(unreadable_record(plan, i));
  RunReport report = run_shown(plan, streams, folder.manifest(), opened, lines);
  folder.finish();
  streams.send();
  lines.check();

  const ExitCode profiled = add_profile(opened, options, report.seconds.solve);
  for (TakeReport& take : report.takes) {
    take.file = streams.named(take.file.string());
    take.failure = streams.named(take.failure);
  }
  if (!options.json.empty()) write_json(options.json, whole_record(plan, opened.report, report));
  if (options.reports() && !streams.writes()) print_report(plan, streams, report, opened.report);
  const ExitCode code = tell_problems(report, plan.passed_by.problems);
  return profiled == ExitCode::done ? code : profiled;
}

ExitCode plan_and_run(const DenoiseLayers& layers, const DenoiseOptions& options,
                      const StandardStreams& streams) {
  if (!options.report.empty()) require_report();
  BatchPlan plan = plan_batch(layers, options);
  if (options.resume) leave_out_done(Manifest(plan.outputs.root), plan);
  for (const std::string& warning : plan.warnings) warn("{}", warning);
  for (const std::string& note : plan.outputs.notes) warn("{}", note);
  if (options.dry_run) {
    say("{}", Lines{streams.named(dry_run_text(plan))});
    return tell_problems({}, plan.passed_by.problems);
  }
  for (const fs::path& file : {options.json, options.lines}) {
    if (file.empty() || file == "-") continue;
    require_writable(file);
    remove_left_beside(file);
  }
  return run_planned(plan, streams);
}

ExitCode run(const DenoiseLayers& layers) {
  DenoiseOptions options = layers.options();
  if (options.limits_memory) return_freed_memory();  // whoever sets a limit means it
  const StandardStreams streams(options);
  try {
    return plan_and_run(layers, options, streams);
  } catch (const ArgumentError& error) {
    throw ArgumentError(streams.named(error.what()));
  } catch (const Cancelled&) {
    throw;
  } catch (const Stopped& stopped) {
    warn("{}", stopped.what());
    return ExitCode::interrupted;
  } catch (const Error& error) {
    throw Error(streams.named(error.what()));
  }
}

ExitCode run_configured(const CLI::App& command, const DenoiseOptions& given) {
  DenoiseLayers layers(command);
  if (!given.config.empty()) layers.add(read_configuration(given.config));
  return run(layers);
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
      "ones are read and the last ones written while the device works. If one fails, the others\n"
      "are written all the same, and it is named at the end (docs/batches.md); a result appears\n"
      "under its name when it is complete.\n"
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
      "  moclean denoise takes/ -o cleaned/ --json cleaned.json\n"
      "  moclean denoise takes/ -o cleaned/ --config takes.toml --resume\n"
      "  cat walk.bvh | moclean denoise - -o - --format bvh > clean.bvh");
  const auto options = std::make_shared<DenoiseOptions>();
  add_denoise_options(command, *options);
  command.callback([&action, &command, options] {
    action = [&command, options] { return run_configured(command, *options); };
  });
}

}  // namespace moclean::cli
