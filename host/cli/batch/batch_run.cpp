#include "cli/batch/batch_run.hpp"

#include <algorithm>
#include <type_traits>
#include <variant>

#include <fmt/format.h>

#include "moclean/core/printable.hpp"
#include "moclean/run/engine.hpp"

namespace moclean::cli {
namespace {

namespace fs = std::filesystem;

template <class Value>
std::vector<Value> picked(const std::vector<Value>& all, const std::vector<std::size_t>& takes) {
  std::vector<Value> some;
  if (all.empty()) return some;
  for (const std::size_t take : takes) some.push_back(all[take]);
  return some;
}

OutputPlan outputs_of(const OutputPlan& all, const std::vector<std::size_t>& takes) {
  OutputPlan some = all;
  some.sources = picked(all.sources, takes);
  some.clean = picked(all.clean, takes);
  some.outliers = picked(all.outliers, takes);
  some.masks = picked(all.masks, takes);
  some.sigmas = picked(all.sigmas, takes);
  some.reports = picked(all.reports, takes);
  some.copies = picked(all.copies, takes);
  return some;
}

Job job_of(const BatchPlan& plan, Manifest* manifest, const std::vector<std::size_t>& takes) {
  const DenoiseOptions& options = plan.options_of(takes.front());
  Job job{.files = picked(plan.outputs.sources, takes),
          .reading = options.reading,
          .outputs = outputs_of(plan.outputs, takes),
          .truths = picked(plan.truths, takes),
          .truth_frames = options.truth_frames,
          .from_rotations = options.from_rotations,
          .chain = options.chain,
          .max_gap = options.max_gap,
          .keep_observed = options.keep_observed,
          .verify = options.verify,
          .jobs = options.jobs,
          .memory_limit = options.memory_limit,
          .overlap = options.overlap,
          .on_failure = plan.goes_on_after_failures() ? FailurePolicy::each_on_its_own
                                                      : FailurePolicy::all_or_nothing};
  if (manifest)
    job.before_commit = [&plan, manifest, takes](std::size_t take,
                                                 const std::vector<CompleteFile>& files) {
      manifest->add(plan.records[takes[take]], files);
    };
  return job;
}

// An event of a group, whose takes are counted from 0, as one of the plan.
RunEvent of_plan(RunEvent event, const std::vector<std::size_t>& takes) {
  std::visit(
      [&](auto& kind) {
        if constexpr (requires { kind.take; }) kind.take = takes[kind.take];
      },
      event);
  return event;
}

void add(const StageSeconds& more, StageSeconds& seconds) {
  seconds.read += more.read;
  seconds.solve += more.solve;
  seconds.write += more.write;
  seconds.total += more.total;
}

}  // namespace

RunReport run_batch(const BatchPlan& plan, Manifest* manifest, Backend& backend,
                    const BatchSink& sink, const std::stop_token& stop) {
  RunReport all;
  all.takes.resize(plan.files.size());
  for (std::size_t i = 0; i < plan.files.size(); ++i) all.takes[i].file = plan.files[i];
  for (const std::vector<std::size_t>& takes : plan.groups()) {
    RunReport some = run_job(
        job_of(plan, manifest, takes), backend,
        [&](const RunEvent& event) { sink(of_plan(event, takes)); }, stop);
    for (std::size_t i = 0; i < takes.size(); ++i) all.takes[takes[i]] = std::move(some.takes[i]);
    add(some.seconds, all.seconds);
    all.batches += some.batches;
    all.peak_memory = std::max(all.peak_memory, some.peak_memory);
  }
  return all;
}

std::string dry_run_text(const BatchPlan& plan) {
  std::string text;
  std::size_t done = 0;
  for (std::size_t i = 0; i < plan.files.size(); ++i) {
    const DenoiseOptions& options = plan.options_of(i);
    done += plan.done[i] ? 1 : 0;
    text += fmt::format("{} -> {}: {}\n", printable_line(plan.outputs.sources[i].string()),
                        printable_line(plan.outputs.clean[i].string()),
                        plan.done[i] ? "left out, done before" : to_string(options.chain));
    for (const FileCopy& copy : plan.outputs.copies[i])
      if (!plan.done[i])
        text += fmt::format("{} -> {}: copied\n", printable_line(copy.from.string()),
                            printable_line(copy.to.string()));
  }
  return text + fmt::format("{} takes to do, {} done before; nothing was written (--dry-run)\n",
                            plan.files.size() - done, done);
}

}  // namespace moclean::cli
