#include "moclean/experiment/run_cells.hpp"

#include <algorithm>
#include <chrono>
#include <optional>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// A cell on its way: its place among all, its key, its noisy take.
struct Job {
  std::size_t place = 0;
  std::string key;
  Corrupted noisy = {};
};

// Noisy take, mask, the method's copy, its batch, A and E there and per take.
std::uint64_t bytes_of(const Recording& clip) {
  return static_cast<std::uint64_t>(clip.samples.size()) * (7 * sizeof(double) + 1);
}

// How much goes into one call: begins with little and grows while calls are short.
class CallSize {
 public:
  explicit CallSize(std::uint64_t most) : most_(most), bytes_(std::min(most, first)) {}

  std::uint64_t bytes() const { return bytes_; }
  void took(double seconds) {
    if (seconds < 5) bytes_ = std::min(most_, 2 * bytes_);
  }

 private:
  static constexpr std::uint64_t first = std::uint64_t{256} << 20;

  std::uint64_t most_;
  std::uint64_t bytes_;
};

void require_frame_rate(const ExperimentTake& take, const ExperimentMethod& method) {
  const std::string step = needs_frame_rate(method.chain);
  if (!step.empty() && !(take.clip.frame_rate > 0))
    throw ArgumentError(fmt::format("{} states no frame rate, which {} needs; give its rate",
                                    take.file.string(), step));
}

// All of them, for the cells of one method.
class MethodRun {
 public:
  MethodRun(const Experiment& experiment, std::span<const Cell> cells, const CellRun& run,
            CallSize& size, std::vector<CellResult>& results)
      : experiment_(experiment), cells_(cells), run_(run), size_(size), results_(results) {}

  /// `todo` are cells of one method; `finished` is called with how many more are done.
  template <class Finished>
  void operator()(std::vector<Job> todo, const Finished& finished) {
    for (auto begin = todo.begin(); begin != todo.end();) {
      std::uint64_t bytes = 0;
      auto end = begin;
      for (; end != todo.end(); ++end) {
        bytes += bytes_of(take_of(*end).clip);
        if (end != begin && bytes > size_.bytes()) break;
      }
      if (run_.monitor.stop.stop_requested()) throw Cancelled();
      call(std::span(begin, end));
      finished(static_cast<Index>(end - begin));
      begin = end;
    }
  }

 private:
  const ExperimentTake& take_of(const Job& job) const {
    return experiment_.takes[cells_[job.place].take];
  }

  void finish(Job& job, CellResult result) {
    if (run_.results) run_.results->keep(job.key, result);
    results_[job.place] = std::move(result);
    job.noisy = {};
  }

  std::vector<Denoised> clean(const Chain& chain, std::span<const Recording> takes) const {
    if (!chain.empty())
      return ChainDenoiser(chain, run_.backend, run_.jobs)
          .denoise(takes, {.stop = run_.monitor.stop});
    std::vector<Denoised> as_they_are;
    for (const Recording& take : takes) {
      Denoised& same = as_they_are.emplace_back();
      same.motion = take.samples;
      same.outliers.setZero(take.samples.rows(), take.samples.cols());
    }
    return as_they_are;
  }

  void call(std::span<Job> jobs) {
    const Chain& chain = experiment_.methods[cells_[jobs.front().place].method].chain;
    std::vector<Job*> members;
    std::vector<Recording> takes;
    for (Job& job : jobs) {
      const Cell& cell = cells_[job.place];
      job.noisy = corrupt(take_of(job).clip, experiment_.noises[cell.noise].noise, cell.noise_seed);
      const bool has_gaps = job.noisy.clip.samples.array().isNaN().any();
      if (has_gaps && !chain.empty() && !accepts_missing(chain)) {
        finish(job, {.refused = "needs every sample", .frames = take_of(job).clip.frames()});
        continue;
      }
      members.push_back(&job);
      takes.push_back(std::move(job.noisy.clip));
    }
    if (takes.empty()) return;
    const Clock::time_point begin = Clock::now();
    std::vector<Denoised> cleaned = clean(chain, takes);
    size_.took(seconds_since(begin));
    for (std::size_t i = 0; i < members.size(); ++i) {
      finish(*members[i], measure(*members[i], cleaned[i]));
      cleaned[i] = {};
    }
  }

  CellResult measure(const Job& job, const Denoised& estimate) const {
    CellResult result{.figures = cell_figures(take_of(job), job.noisy.touched, estimate),
                      .frames = estimate.motion.rows()};
    result.figures["seconds"] = estimate.solve_seconds;
    result.unconverged = std::ranges::count_if(
        estimate.segments, [](const DenoisedSegment& s) { return fell_short(s.outcome); });
    return result;
  }

  const Experiment& experiment_;
  std::span<const Cell> cells_;
  const CellRun& run_;
  CallSize& size_;
  std::vector<CellResult>& results_;
};

// The same take is asked for often, and its hash takes time.
std::vector<std::string> keys_of(const Experiment& experiment, std::span<const Cell> cells,
                                 const CellRun& run) {
  std::vector<std::string> identities, keys;
  for (const ExperimentTake& take : experiment.takes) identities.push_back(take_identity(take));
  for (const Cell& cell : cells) {
    const bool on_device = needs_backend(experiment.methods[cell.method].chain);
    keys.push_back(cell_key(experiment, cell, identities[cell.take],
                            run.program + " | " + (on_device ? run.device : "host")));
  }
  return keys;
}

}  // namespace

std::vector<CellResult> run_cells(const Experiment& experiment, std::span<const Cell> cells,
                                  const CellRun& run) {
  std::vector<CellResult> results(cells.size());
  std::vector<std::vector<Job>> todo(experiment.methods.size());
  std::vector<std::string> keys;
  if (run.results) keys = keys_of(experiment, cells, run);
  Progress progress{.finished = 0, .total = static_cast<Index>(cells.size())};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    require_frame_rate(experiment.takes[cells[i].take], experiment.methods[cells[i].method]);
    const CellResult* known = run.results ? run.results->find(keys[i]) : nullptr;
    if (known)
      results[i] = *known;
    else
      todo[cells[i].method].push_back({.place = i, .key = run.results ? keys[i] : ""});
    progress.finished += known != nullptr;
  }

  CallSize size(run.memory);
  MethodRun method_run(experiment, cells, run, size, results);
  for (std::vector<Job>& jobs : todo)
    method_run(std::move(jobs), [&](Index more) {
      progress.finished += more;
      if (run.monitor.report) run.monitor.report(progress);
    });
  return results;
}

}  // namespace moclean
