#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/io/file.hpp"
#include "moclean/io/read_write.hpp"
#include "moclean/solve/opencl/opencl_backend.hpp"
#include "moclean/solve/reference/reference_backend.hpp"

#include "cli/commands.hpp"
#include "cli/denoise_options.hpp"
#include "cli/interrupt.hpp"
#include "cli/json_record.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"

namespace moclean::cli {
namespace {

namespace fs = std::filesystem;

struct OpenedBackend {
  std::unique_ptr<Device> device;  // has to outlive the backend
  std::unique_ptr<Backend> backend;
};

OpenedBackend open_backend(const DenoiseOptions& options) {
  if (options.backend == "reference")
    return {nullptr, std::make_unique<ReferenceBackend>(options.jobs)};
  auto device = std::make_unique<Device>(options.device);
  auto backend =
      std::make_unique<OpenClBackend>(*device, OpenClOptions{.products = options.products});
  return {std::move(device), std::move(backend)};
}

std::vector<Denoised> solve(const DenoiseOptions& options, Backend& backend,
                            const std::vector<Clip>& clips, const Interrupt& interrupt,
                            const char* task) {
  ProgressLine line(task, !options.quiet);
  const Monitor monitor{.report = [&](const Progress& progress) { line.show(progress); },
                        .stop = interrupt.token()};
  auto results =
      LowRankDenoiser(options.segmentation, options.method, backend).denoise(clips, monitor);
  interrupt.check();
  return results;
}

std::vector<TakeReport> reports_of(const std::vector<fs::path>& files, const Takes& takes,
                                   const std::vector<Denoised>& results) {
  std::vector<TakeReport> reports;
  for (std::size_t i = 0; i < files.size(); ++i)
    reports.push_back({.file = files[i],
                       .frames = results[i].clip.frames(),
                       .columns = results[i].clip.samples.cols(),
                       .read_seconds = takes.read_seconds[i],
                       .solve_seconds = results[i].solve_seconds,
                       .write_seconds = 0,
                       .segments = results[i].segments,
                       .verification = {}});
  return reports;
}

std::string agreement_line(const TakeReport& take) {
  const auto& [agreement, largest] = *take.verification;
  return fmt::format(
      "{}: difference to the reference: motion {:.1e} (bound {:.0e}), outliers {:.1e} (bound "
      "{:.0e}), largest {:.1e}; iterations {}, ranks {}",
      take.file.string(), agreement.low_rank, low_rank_agreement_bound, agreement.sparse,
      sparse_agreement_bound, largest, agreement.same_iterations ? "equal" : "differ",
      agreement.same_rank ? "equal" : "differ");
}

// Solves everything again with the reference and compares. Throws Error if a take differs.
void verify(const DenoiseOptions& options, const std::vector<Clip>& clips,
            const std::vector<Denoised>& results, const Interrupt& interrupt,
            std::vector<TakeReport>& reports) {
  ReferenceBackend reference(options.jobs);
  const auto expected = solve(options, reference, clips, interrupt, "verifying");
  std::string failures;
  for (std::size_t i = 0; i < clips.size(); ++i) {
    const Matrix difference = results[i].clip.samples - expected[i].clip.samples;
    reports[i].verification = {agreement(results[i], expected[i]),
                               difference.cwiseAbs().maxCoeff()};
    if (!within(reports[i].verification->agreement)) failures += "\n" + agreement_line(reports[i]);
  }
  if (!failures.empty())
    throw Error("not verified, nothing was written; the device and the reference differ:" +
                failures);
}

void write(const OutputPlan& plan, const std::vector<Denoised>& results,
           std::vector<TakeReport>& reports) {
  for (const fs::path& folder : plan.folders) fs::create_directories(folder);
  for (std::size_t i = 0; i < results.size(); ++i) {
    const auto begin = std::chrono::steady_clock::now();
    write_clip(plan.clean[i], results[i].clip);
    if (!plan.outliers.empty()) write_clip(plan.outliers[i], results[i].outliers);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    reports[i].write_seconds = seconds.count();
  }
}

void write_json(const fs::path& file, const std::string& text) {
  if (file == "-") {
    fmt::print("{}", text);
    return;
  }
  AtomicFile target(file);
  target.write(text);
  target.commit();
}

// `7`, or `5-9` if the segments differ.
template <class Value>
std::string range(const std::vector<DenoisedSegment>& segments, const Value& value) {
  const auto [least, most] = std::ranges::minmax(segments, {}, value);
  return value(least) == value(most) ? fmt::format("{}", value(least))
                                     : fmt::format("{}-{}", value(least), value(most));
}

void print_summary(const TakeReport& take, const fs::path& result) {
  fmt::print(
      "{} -> {}: {} frames x {} columns, segments {}, iterations {}, rank {}, {:.3f} s, {:.0f} "
      "frames/s\n",
      take.file.string(), result.string(), take.frames, take.columns, take.segments.size(),
      range(take.segments, [](const DenoisedSegment& s) { return s.outcome.iterations; }),
      range(take.segments, [](const DenoisedSegment& s) { return s.outcome.rank; }),
      take.solve_seconds, take.frames_per_second());
  if (take.verification) fmt::print("{}\n", agreement_line(take));
}

ExitCode warn_if_not_converged(const std::vector<TakeReport>& takes) {
  ExitCode code = ExitCode::done;
  for (const TakeReport& take : takes) {
    const auto failed = std::ranges::count_if(
        take.segments, [](const DenoisedSegment& s) { return !s.outcome.converged; });
    if (failed == 0) continue;
    fmt::print(stderr,
               "moclean: {}: {} of {} segments did not converge; raise --max-iterations or "
               "--tolerance\n",
               take.file.string(), failed, take.segments.size());
    code = ExitCode::not_converged;
  }
  return code;
}

ExitCode run(DenoiseOptions options) {
  complete(options);
  const Interrupt interrupt;  // before the threads of the OpenCL driver
  const std::vector<fs::path> files = expand_folders(options.inputs);
  const OutputPlan plan =
      plan_outputs({options.inputs, files, options.output, options.outliers, options.format});
  if (!options.json.empty() && options.json != "-") require_writable(options.json);

  const OpenedBackend opened = open_backend(options);
  const Takes takes = read_takes(files, options.reading, options.jobs, interrupt.token());
  const auto results = solve(options, *opened.backend, takes.clips, interrupt, "solving");
  auto reports = reports_of(files, takes, results);
  if (options.verify) verify(options, takes.clips, results, interrupt, reports);

  write(plan, results, reports);
  if (!options.json.empty())
    write_json(options.json, to_text(json_record(options, opened.backend->name(), reports)));
  if (options.reports())
    for (std::size_t i = 0; i < reports.size(); ++i) print_summary(reports[i], plan.clean[i]);
  return warn_if_not_converged(reports);
}

}  // namespace

void add_denoise(CLI::App& program, Action& action) {
  CLI::App& command = *program.add_subcommand("denoise", "Clean recordings");
  command.footer(
      "Several recordings are solved together and give the same files as single calls. If one\n"
      "cannot be read, nothing is written for any. Ctrl-C stops before anything is written.\n"
      "Exit codes: 0 done, 1 failed input or device (or --verify), 2 usage, 3 written, but a\n"
      "segment did not converge, 130 interrupted.\n\n"
      "The bounds of --verify hold for the default tolerance and are the same for any other.\n\n"
      "Example:\n"
      "  moclean denoise walk.bvh -o clean.csv --segment-length 200 --verify\n"
      "  moclean denoise takes/ -o cleaned/ --json cleaned.json");
  const auto options = std::make_shared<DenoiseOptions>();
  add_denoise_options(command, *options);
  command.callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace moclean::cli
