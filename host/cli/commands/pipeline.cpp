#include "cli/commands/pipeline.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/parallel.hpp"
#include "moclean/denoise/sample_status.hpp"
#include "moclean/metric/metric.hpp"
#include "moclean/run/process_memory.hpp"
#include "moclean/run/result_writer.hpp"
#include "moclean/run/take_reader.hpp"
#include "moclean/run/truth.hpp"
#include "moclean/solve/reference/reference_backend.hpp"

#include "cli/commands/denoise_report.hpp"
#include "cli/printing/progress_line.hpp"

namespace moclean::cli {
namespace {

// Copies of a take's samples, at most: read 1, stacked 1, solved 2, unstacked 2 and their padding;
// with --verify two more while the reference works, and one of a truth. Written they are 2; a
// report has the noisy take and the truth besides, and the text of the page four times. A chain of
// several steps keeps what it began with. Segments that overlap are stacked and solved at twice
// their length at most, as are those of the reference. A mask and sigma are one more each. Batches
// of automatic segments are four times the takes, data and two results; there are medians, too.
constexpr std::uint64_t copies_solving = 7, copies_verifying = 9, copies_of_truth = 1,
                        copies_chained = 2, copies_overlapping = 4, copies_of_side = 1,
                        copies_choosing = 14, copies_writing = 2, copies_reporting = 8;

bool overlaps(const Step& step) {
  if (std::holds_alternative<Automatic>(step)) return true;
  const auto* low_rank = std::get_if<LowRank>(&step);
  return low_rank && low_rank->segmentation.overlap > 0;
}

bool is_automatic(const Step& step) {
  const auto* low_rank = std::get_if<LowRank>(&step);
  return low_rank && low_rank->segmentation.automatic;
}

std::uint64_t copies_of_sides(const DenoiseOptions& options) {
  return copies_of_side * (!options.mask.empty() + !options.sigma.empty());
}

GroupRules rules_of(const Job& job) {
  // A GPU gives a work-group to every segment; the eigensolver takes as long for one as for as many
  // as the units hold, ten or more each (docs/gpu.md).
  constexpr Index segments_per_unit = 32, least_per_gpu_unit = 8;
  const Chain& chain = job.options.chain;
  const LowRank* method = first_low_rank(chain);
  GroupRules rules{.segmentation = method ? method->segmentation : Segmentation{.whole = true}};
  rules.needs = {.every_sample = !accepts_missing(chain),
                 .frame_rate_for = needs_frame_rate(chain)};
  if (rules.needs.frame_rate_for.empty() && job.options.max_gap)
    rules.needs.frame_rate_for = "--max-gap";
  if (job.on_gpu)
    rules.least_segments = std::max(rules.least_segments, least_per_gpu_unit * job.compute_units);
  rules.full_segments = std::max(rules.least_segments, segments_per_unit * job.compute_units);
  rules.copies = job.options.verify ? copies_verifying : copies_solving;
  if (!job.truths.empty() || !job.options.report.empty()) rules.copies += copies_of_truth;
  rules.copies += copies_of_sides(job.options);
  if (std::ranges::any_of(chain, is_automatic)) rules.copies += copies_choosing;
  if (std::ranges::any_of(chain, overlaps)) rules.copies += copies_overlapping;
  if (chain.size() > 1) rules.copies += copies_chained;
  return rules;
}

std::uint64_t host_limit(const DenoiseOptions& options) {
  if (!options.overlap) return std::numeric_limits<std::uint64_t>::max();
  return options.memory_limit - device_share(options.memory_limit);
}

AgreementBounds agreement_bounds(const DenoiseOptions& options) {
  if (options.precision == Precision::mixed) return mixed_agreement_bounds;
  const auto smooths = [](const Step& step) { return std::holds_alternative<Automatic>(step); };
  return std::ranges::any_of(options.chain, smooths) ? smoothing_agreement_bounds
                                                     : AgreementBounds{};
}

void require_going(const std::stop_token& stop) {
  if (stop.stop_requested()) throw Cancelled();
}

// One way to solve groups, with its line of progress.
class Solver {
 public:
  Solver(const Job& job, Backend& backend, const std::stop_token& stop, const char* task)
      : stop_(stop),
        denoiser_(job.options.chain, &backend, job.options.jobs),
        line_(task, !job.options.quiet) {}

  std::vector<Denoised> solve(const TakeGroup& group, Index expected_segments, bool is_last) {
    const BusyClock::Work work(clock_);
    const Monitor monitor{.report =
                              [&](const Progress& own) {
                                line_.show(
                                    {.finished = finished_ + own.finished,
                                     .total = std::max(expected_segments, finished_ + own.total)},
                                    is_last ? ProgressTotal::exact : ProgressTotal::estimated);
                              },
                          .stop = stop_};
    auto results = denoiser_.denoise(group.clips, monitor);
    require_going(stop_);
    finished_ += group.segments;
    return results;
  }

  double seconds() const { return clock_.seconds(); }

 private:
  std::stop_token stop_;
  ChainDenoiser denoiser_;
  ProgressLine line_;
  BusyClock clock_;
  Index finished_ = 0;  // segments of the groups before
};

// The stages of a run and what they have produced so far.
class Run {
 public:
  Run(const Job& job, Backend& backend, const std::stop_token& stop)
      : job_(job),
        stop_(stop),
        budget_(host_limit(job.options)),
        writer_(job.plan, job.options.jobs),
        reader_(job.files, job.options.reading, rules_of(job), job.options.jobs, budget_, stop),
        solver_(job, backend, stop, "solving") {
    if (!job.options.verify) return;
    reference_.emplace(job.options.jobs);
    verifier_.emplace(job, *reference_, stop, "verifying");
  }

  RunReport report() {
    job_.options.overlap ? overlapped() : one_after_the_other();
    writer_.finish();
    require_going(stop_);
    writer_.commit();
    for (std::size_t i = 0; i < report_.takes.size(); ++i)
      report_.takes[i].write_seconds = writer_.seconds(i);
    report_.seconds = {.read = reader_.seconds(),
                       .solve = solver_.seconds(),
                       .write = writer_.seconds(),
                       .total = all_.seconds()};
    report_.peak_memory = peak_memory();
    return std::move(report_);
  }

 private:
  void overlapped() {
    for (TakeGroup group = reader_.next(); !group.clips.empty(); group = reader_.next())
      put(group, solved(group));
  }

  void one_after_the_other() {
    std::vector<TakeGroup> groups;
    while (!reader_.at_end()) groups.push_back(reader_.next());
    std::vector<std::vector<Denoised>> results;
    for (const TakeGroup& group : groups) results.push_back(solved(group));
    for (std::size_t g = 0; g < groups.size(); ++g) put(groups[g], std::move(results[g]));
  }

  std::vector<Denoised> solved(const TakeGroup& group) {
    const Index expected = reader_.expected_segments();
    read_truths(group);  // before the work: one of another shape ends the run
    auto results = solved_by_device(group, expected);
    for (std::size_t i = 0; i < results.size(); ++i)
      report_.takes.push_back({.file = job_.files[group.first + i],
                               .unit = results[i].clip.unit,
                               .frames = results[i].clip.frames(),
                               .columns = results[i].clip.samples.cols(),
                               .read_seconds = group.read_seconds[i],
                               .solve_seconds = results[i].solve_seconds,
                               .write_seconds = 0,
                               .status = {},
                               .changed = {},
                               .tells_trust = results[i].trusted.has_value(),
                               .segments = results[i].segments,
                               .unobserved = results[i].unobserved,
                               .verification = {},
                               .truth = {}});
    if (verifier_) verify(group, results, verifier_->solve(group, expected, reader_.at_end()));
    finish(group, results);
    ++report_.groups;
    return results;
  }

  // What the method has made becomes what the options ask for.
  void finish(const TakeGroup& group, std::vector<Denoised>& results) {
    std::vector<Clip> status(results.size());
    for_each_index(static_cast<Index>(results.size()), job_.options.jobs, [&](Index take) {
      const auto i = static_cast<std::size_t>(take);
      status[i] = finished(group.clips[i], results[i], report_.takes[group.first + i]);
    });
    for (std::size_t i = 0; i < results.size(); ++i) {
      report_.takes[group.first + i].truth = compared(group, i, results[i].clip);
      if (!job_.options.mask.empty()) masks_[group.first + i] = std::move(status[i]);
    }
  }

  // Returns what became of the samples.
  Clip finished(const Clip& take, Denoised& result, TakeReport& report) const {
    const DenoiseOptions& options = job_.options;
    if (options.max_gap) leave_long_gaps(take, *options.max_gap, result);
    if (options.keep_observed) keep_observed(take, result);
    Clip status = sample_status(take, result);
    report.status = count_status(status);
    report.changed = change_of(take, result);
    if (options.mask.empty()) status = {};  // memory of many takes
    return status;
  }

  std::optional<Clip> mask_of(std::size_t take) {
    auto mask = masks_.extract(take);
    if (mask.empty()) return std::nullopt;
    return std::move(mask.mapped());
  }

  void read_truths(const TakeGroup& group) {
    if (job_.truths.empty()) return;
    InputOptions reading = job_.options.reading;
    if (job_.options.truth_frames) reading.frames = *job_.options.truth_frames;
    for (std::size_t i = 0; i < group.clips.size(); ++i)
      truths_[group.first + i] = read_truth(job_.truths[group.first + i], reading, group.clips[i]);
  }

  std::optional<TruthReport> compared(const TakeGroup& group, std::size_t i, const Clip& clean) {
    const std::size_t take = group.first + i;
    if (job_.truths.empty()) return std::nullopt;
    const Matrix& truth = truths_.at(take).samples;
    TruthReport found{.file = job_.truths[take],
                      .fd_noisy = frobenius_distance(truth, group.clips[i].samples),
                      .fd_clean = frobenius_distance(truth, clean.samples)};
    if (job_.options.report.empty()) truths_.erase(take);
    return found;
  }

  // The clean take and the outliers come to it when they are written.
  std::optional<Report> report_of(TakeGroup& group, std::size_t i) {
    if (job_.options.report.empty()) return std::nullopt;
    const std::size_t take = group.first + i;
    ReportTake parts{.noisy = std::move(group.clips[i]), .segments = report_.takes[take].segments};
    if (!job_.truths.empty()) {
      parts.truth = std::move(truths_.at(take));
      truths_.erase(take);
    }
    parts.parents = parents_of(job_, take, parts.noisy);
    return denoise_report(job_, report_.takes[take], std::move(parts));
  }

  // A take that needs more than the device's share of the memory is alone in its group.
  std::vector<Denoised> solved_by_device(const TakeGroup& group, Index expected_segments) {
    try {
      return solver_.solve(group, expected_segments, reader_.at_end());
    } catch (const TakeError& error) {
      throw FileError(job_.files[group.first + error.take()], error.problem());
    } catch (const DeviceError& error) {
      if (group.clips.size() > 1) throw;
      throw DeviceError(fmt::format("{}: {}", job_.files[group.first].string(), error.what()));
    }
  }

  void verify(const TakeGroup& group, const std::vector<Denoised>& results,
              const std::vector<Denoised>& expected) {
    std::string failures;
    for (std::size_t i = 0; i < results.size(); ++i) {
      TakeReport& take = report_.takes[group.first + i];
      const Matrix difference = difference_of(results[i].clip.samples, expected[i].clip.samples);
      const AgreementBounds bounds = agreement_bounds(job_.options);
      take.verification = {agreement(results[i], expected[i]), bounds,
                           difference.cwiseAbs().maxCoeff()};
      if (!within(take.verification->agreement, bounds)) failures += "\n" + agreement_line(take);
    }
    if (!failures.empty())
      throw Error("not verified, nothing was written; the device and the reference differ:" +
                  failures);
  }

  void put(TakeGroup& group, std::vector<Denoised> results) {
    for (std::size_t i = 0; i < results.size(); ++i) {
      std::optional<Report> report = report_of(group, i);
      group.clips[i] = {};
      group.memory[i].resize(
          group.memory[i].bytes() / rules_of(job_).copies *
          ((report ? copies_reporting : copies_writing) + copies_of_sides(job_.options)));
      writer_.put({.index = group.first + i,
                   .clip = std::move(results[i].clip),
                   .outliers = std::move(results[i].outliers),
                   .mask = mask_of(group.first + i),
                   .sigma = job_.options.sigma.empty() ? std::nullopt : std::move(results[i].sigma),
                   .report = std::move(report),
                   .memory = std::move(group.memory[i])});
    }
  }

  const Job& job_;
  std::stop_token stop_;
  BusyClock clock_;
  const BusyClock::Work all_{clock_};  // reading begins when the reader is made
  RunReport report_;
  std::map<std::size_t, Clip> masks_;   // by take, from when it is solved until it is written
  std::map<std::size_t, Clip> truths_;  // by take, from before it is solved until it is written
  MemoryBudget budget_;
  ResultWriter writer_;
  TakeReader reader_;
  Solver solver_;
  std::optional<ReferenceBackend> reference_;
  std::optional<Solver> verifier_;
};

}  // namespace

RunReport run_pipeline(const Job& job, Backend& backend, const std::stop_token& stop) {
  return Run(job, backend, stop).report();
}

}  // namespace moclean::cli
