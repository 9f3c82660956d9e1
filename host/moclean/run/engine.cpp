#include "moclean/run/engine.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "moclean/backend/reference_backend.hpp"
#include "moclean/core/error.hpp"
#include "moclean/core/parallel.hpp"
#include "moclean/denoise/sample_status.hpp"
#include "moclean/metric/metric.hpp"
#include "moclean/run/process_memory.hpp"
#include "moclean/run/result_writer.hpp"
#include "moclean/run/run_log.hpp"
#include "moclean/run/take_page.hpp"
#include "moclean/run/take_reader.hpp"
#include "moclean/run/truth.hpp"

namespace moclean {
namespace {

std::uint64_t host_limit(const Job& job) {
  if (!job.overlap) return std::numeric_limits<std::uint64_t>::max();
  return job.memory_limit - device_share(job.memory_limit);
}

AgreementBounds agreement_bounds(const Chain& chain, bool mixed) {
  if (mixed) return mixed_agreement_bounds;
  const auto smooths = [](const Step& step) { return std::holds_alternative<Automatic>(step); };
  return std::ranges::any_of(chain, smooths) ? smoothing_agreement_bounds : AgreementBounds{};
}

void require_going(const std::stop_token& stop) {
  if (stop.stop_requested()) throw Cancelled();
}

// What the reader can say of the segments of all takes.
struct Expected {
  Index segments = 0;
  bool exact = false;
};

// One way to solve takes; tells how far it is.
class Solver {
 public:
  Solver(SolveTask task, const Job& job, Backend& backend, RunLog& log, const std::stop_token& stop)
      : task_(task), denoiser_(job.chain, &backend, job.jobs), log_(log), stop_(stop) {}

  std::vector<Denoised> solve(std::span<const Recording> clips, Index segments, Expected expected) {
    const BusyClock::Work work(clock_);
    const Monitor monitor{
        .report =
            [&](const Progress& own) {
              log_.send(SegmentsSolved{
                  .task = task_,
                  .progress = {.finished = finished_ + own.finished,
                               .total = std::max(expected.segments, finished_ + own.total)},
                  .total_is_exact = expected.exact});
            },
        .stop = stop_};
    auto results = denoiser_.denoise(clips, monitor);
    require_going(stop_);
    finished_ += segments;
    return results;
  }

  double seconds() const { return clock_.seconds(); }

 private:
  SolveTask task_;
  ChainDenoiser denoiser_;
  RunLog& log_;
  std::stop_token stop_;
  BusyClock clock_;
  Index finished_ = 0;  // segments of the takes before
};

// The stages of a run and what they have produced so far.
class Run {
 public:
  Run(const Job& job, Backend& backend, const EventSink& sink, const std::stop_token& stop)
      : job_(job),
        backend_(backend),
        stop_(stop),
        log_(job.on_failure, job.files.size(), with_reports(sink)),
        rules_(rules_of(job, backend.traits())),
        budget_(host_limit(job)),
        writer_(job, log_),
        reader_(job, rules_, budget_, log_, stop),
        solver_(SolveTask::solving, job, backend, log_, stop) {
    report_.takes.resize(job.files.size());
    for (std::size_t i = 0; i < job.files.size(); ++i) report_.takes[i].file = job.files[i];
    if (!job.verify) return;
    reference_.emplace(job.jobs);
    verifier_.emplace(SolveTask::verifying, job, *reference_, log_, stop);
  }

  RunReport report() {
    job_.overlap ? overlapped() : one_after_the_other();
    writer_.finish();
    require_going(stop_);
    writer_.commit();
    for (std::size_t i = 0; i < report_.takes.size(); ++i) {
      report_.takes[i].write_seconds = writer_.seconds(i);
      report_.takes[i].failure = log_.problem(i);
    }
    report_.seconds = {.read = reader_.seconds(),
                       .solve = solver_.seconds(),
                       .write = writer_.seconds(),
                       .total = all_.seconds()};
    report_.peak_memory = peak_memory();
    return std::move(report_);
  }

 private:
  // By the time a take is written or has failed no other thread works on its report.
  EventSink with_reports(const EventSink& sink) {
    if (!sink) return {};
    return [this, sink](const RunEvent& event) {
      if (const auto* written = std::get_if<TakeWritten>(&event)) {
        TakeReport& report = report_.takes[written->take];
        report.write_seconds = writer_.seconds(written->take);
        sink(TakeWritten{written->take, &report});
      } else if (const auto* failed = std::get_if<TakeFailed>(&event)) {
        TakeReport& report = report_.takes[failed->take];
        report.failure = failed->problem;
        sink(TakeFailed{failed->take, failed->problem, &report});
      } else {
        sink(event);
      }
    };
  }

  void overlapped() {
    for (TakeBatch batch = reader_.next(); batch.size() > 0; batch = reader_.next()) {
      solve(batch);
      write(batch);
    }
  }

  void one_after_the_other() {
    std::vector<TakeBatch> batches;
    while (!reader_.at_end()) batches.push_back(reader_.next());
    for (TakeBatch& batch : batches) solve(batch);
    for (TakeBatch& batch : batches) write(batch);
  }

  // A take that fails leaves its batch, here and below, where the run goes on without it.
  void solve(TakeBatch& batch) {
    const Expected expected{reader_.expected_segments(), reader_.at_end()};
    read_truths(batch);  // before the work: one of another shape is a failure
    std::vector<Denoised> results = solved(solver_, batch, expected);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      batch.takes[i].result = std::move(results[i]);
      record(batch.clips[i], batch.takes[i]);
    }
    if (verifier_) verify(batch, solved(*verifier_, batch, expected));
    keep_if(batch, job_.jobs, [&](const Recording& clip, TakeInHand& take) { finish(clip, take); });
    if (batch.size() > 0) ++report_.batches;
  }

  void read_truths(TakeBatch& batch) {
    if (job_.truths.empty()) return;
    ReadOptions reading = job_.reading;
    if (job_.truth_frames) reading.frames = *job_.truth_frames;
    keep_if(batch, 1, [&](const Recording& clip, TakeInHand& take) {
      take.truth = read_truth(job_.truths[take.index], reading, clip);
    });
  }

  // The results of the takes that stay in the batch.
  std::vector<Denoised> solved(Solver& solver, TakeBatch& batch, Expected expected) {
    if (batch.size() < 2) return solved_alone(solver, batch, expected);
    bool refused = false;
    try {
      return solver.solve(batch.clips, batch.segments(), expected);
    } catch (const TakeError& error) {  // thrown before anything is computed
      const std::size_t take = batch.takes[error.take()].index;
      log_.attempt(take, [&] { throw FileError(job_.files[take], error.problem()); });
      batch.drop(error.take());
      refused = true;
    } catch (const Cancelled&) {
      throw;
    } catch (const std::exception&) {
      if (log_.all_or_nothing()) throw;
    }
    return refused ? solved(solver, batch, expected) : solved_alone(solver, batch, expected);
  }

  // What fails for a batch, memory of the device say, may work for its takes. A take that needs
  // more than the device's share of the memory is alone in its batch from the start.
  std::vector<Denoised> solved_alone(Solver& solver, TakeBatch& batch, Expected expected) {
    std::vector<Denoised> results;
    keep_if(batch, 1, [&](const Recording& clip, const TakeInHand& take) {
      try {
        results.push_back(naming(job_.files[take.index], "clean it", [&] {
          return std::move(solver.solve({&clip, 1}, take.segments, expected).front());
        }));
      } catch (const TakeError& error) {
        throw FileError(job_.files[take.index], error.problem());
      } catch (const DeviceError& error) {
        throw DeviceError(fmt::format("{}: {}", job_.files[take.index].string(), error.what()));
      } catch (const Cancelled&) {
        throw;
      } catch (const ArgumentError& error) {  // a wrong use, also where only a take shows it
        throw ArgumentError(fmt::format("{}: {}", job_.files[take.index].string(), error.what()));
      } catch (const Error& error) {
        throw FileError(job_.files[take.index], error.what());
      }
    });
    return results;
  }

  void record(const Recording& clip, const TakeInHand& take) {
    TakeReport& report = report_.takes[take.index];
    report.notes = clip.notes;
    report.unit = clip.unit;
    report.frames = clip.frames();
    report.columns = clip.samples.cols();
    report.read_seconds = take.read_seconds;
    report.solve_seconds = take.result.solve_seconds;
    report.tells_trust = take.result.trusted.has_value();
    report.segments = take.result.segments;
    report.unobserved = take.result.unobserved;
  }

  void verify(TakeBatch& batch, const std::vector<Denoised>& expected) {
    const AgreementBounds bounds = agreement_bounds(job_.chain, backend_.traits().mixed);
    std::string differences;
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const Denoised& result = batch.takes[i].result;
      const Matrix difference = difference_of(result.motion, expected[i].motion);
      TakeReport& report = report_.takes[batch.takes[i].index];
      report.verification = {agreement(result, expected[i]), bounds,
                             difference.cwiseAbs().maxCoeff()};
      if (!within(report.verification->agreement, bounds))
        differences += "\n" + agreement_line(report);
    }
    if (!differences.empty() && log_.all_or_nothing())
      throw Error("not verified, nothing was written; the device and the reference differ:" +
                  differences);
    keep_if(batch, 1, [&](const Recording&, const TakeInHand& take) {
      const TakeReport& report = report_.takes[take.index];
      if (!within(report.verification->agreement, bounds))
        throw Error("not verified, not written: " + agreement_line(report));
    });
  }

  // What the method has made becomes what the job asks for.
  void finish(const Recording& clip, TakeInHand& take) {
    TakeReport& report = report_.takes[take.index];
    require_numbers(clip, take);
    if (job_.max_gap) leave_long_gaps(clip, *job_.max_gap, take.result);
    const Mask trusted = trusted_samples(clip, take.result);
    if (job_.keep_observed) keep_observed(clip, trusted, take.result);
    report.status = count_status(clip, take.result, trusted);
    report.changed = change_of(clip, take.result.motion, report.status);
    if (!job_.outputs.masks.empty() || !job_.outputs.reports.empty())
      take.mask = status_numbers(clip, take.result, trusted);
    if (!take.truth) return;
    const Matrix& truth = take.truth->samples;
    report.truth = TruthReport{.file = job_.truths[take.index],
                               .fd_noisy = frobenius_distance(truth, clip.samples),
                               .fd_clean = frobenius_distance(truth, take.result.motion)};
    if (job_.outputs.reports.empty()) take.truth.reset();
  }

  // A sample that was observed and not rejected stays one: parameters out of proportion to the
  // samples must not lose it without a word.
  void require_numbers(const Recording& clip, const TakeInHand& take) const {
    const Matrix& motion = take.result.motion;
    const Mask lost = trusted_samples(clip, take.result) && !motion.array().isFinite();
    if (!lost.any()) return;
    Index frame = 0, column = 0;
    lost.cast<int>().maxCoeff(&frame, &column);
    throw FileError(
        job_.files[take.index],
        fmt::format("{} makes no number of {} in frame {}, column {}: do its parameters fit the "
                    "size of the samples?",
                    to_string(job_.chain), clip.samples(frame, column),
                    job_.reading.frames.first.value_or(0) + frame,
                    clip.columns[static_cast<std::size_t>(column)]));
  }

  void write(TakeBatch& batch) {
    for (std::size_t i = 0; i < batch.size(); ++i) {
      TakeInHand& take = batch.takes[i];
      Recording& clean = batch.clips[i];
      std::optional<Report> page;
      if (!job_.outputs.reports.empty()) page = page_of(clean, take);
      clean.samples = std::move(take.result.motion);
      take.memory.resize(bytes_of(clean, rules_.copies_writing));
      writer_.put(
          {.index = take.index,
           .clean = std::move(clean),
           .outliers = std::move(take.result.outliers),
           .mask = job_.outputs.masks.empty() ? std::nullopt : std::move(take.mask),
           .sigma = job_.outputs.sigmas.empty() ? std::nullopt : std::move(take.result.sigma),
           .report = std::move(page),
           .memory = std::move(take.memory)});
      take = {};
    }
  }

  // Takes the samples of the take. The clean take and the outliers come to it when they are
  // written.
  Report page_of(Recording& noisy, TakeInHand& take) const {
    const TakeReport& report = report_.takes[take.index];
    std::vector<int> parents = parents_of(noisy, take.truth ? &*take.truth : nullptr);
    ReportTake parts{.noisy = like(noisy, std::move(noisy.samples)),
                     .truth = std::move(take.truth),
                     .status = take.mask,
                     .sigma = take.result.sigma,
                     .parents = std::move(parents),
                     .segments = report.segments};
    return take_page(job_, backend_, report, std::move(parts));
  }

  // Works on every take of a batch, on up to `threads`; those for which that fails leave it.
  template <class Work>
  void keep_if(TakeBatch& batch, int threads, const Work& work) {
    std::vector<char> kept(batch.size());
    for_each_index(static_cast<Index>(batch.size()), threads, [&](Index place) {
      const auto i = static_cast<std::size_t>(place);
      TakeInHand& take = batch.takes[i];
      kept[i] = log_.attempt(take.index, [&] { work(batch.clips[i], take); });
    });
    for (std::size_t i = kept.size(); i-- > 0;)
      if (!kept[i]) batch.drop(i);
  }

  const Job& job_;
  Backend& backend_;
  std::stop_token stop_;
  BusyClock clock_;
  const BusyClock::Work all_{clock_};  // reading begins when the reader is made
  RunReport report_;
  RunLog log_;
  const BatchRules rules_;
  MemoryBudget budget_;
  ResultWriter writer_;
  TakeReader reader_;
  Solver solver_;
  std::optional<ReferenceBackend> reference_;
  std::optional<Solver> verifier_;
};

}  // namespace

RunReport run_job(const Job& job, Backend& backend, const EventSink& sink,
                  const std::stop_token& stop) {
  return Run(job, backend, sink, stop).report();
}

}  // namespace moclean
