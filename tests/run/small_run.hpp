#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "moclean/backend/reference_backend.hpp"
#include "moclean/core/error.hpp"
#include "moclean/formats/read_write.hpp"
#include "moclean/run/engine.hpp"

#include "support/synthetic_walk.hpp"
#include "support/temporary_folder.hpp"

namespace moclean::test {

/// Takes three quarters of every sample as motion.
class ThreeQuarters final : public Backend {
 public:
  std::string name() const override { return "three quarters"; }
  BackendTraits traits() const override { return wants; }

  Solution solve(const Problem& problem, const Method&, const Monitor& monitor) override {
    const SegmentBatch& data = problem.data;
    calls.push_back(data.rows() * data.columns() * Index{sizeof(double)});
    before_solving(calls.size());
    if (monitor.stop.stop_requested()) throw Cancelled();
    Solution solution{data, data,
                      std::vector<SegmentOutcome>(static_cast<std::size_t>(data.segments()))};
    for (double& sample : solution.low_rank.storage()) sample *= 0.75;
    for (double& sample : solution.sparse.storage()) sample *= 0.25;
    return solution;
  }

  BackendTraits wants;
  std::vector<Index> calls;  ///< bytes of samples of each
  std::function<void(std::size_t call)> before_solving = [](std::size_t) {};
};

/// Right, but for one call: what Job::verify is there to find.
class WrongOnce final : public Backend {
 public:
  explicit WrongOnce(int wrong_call) : wrong_call_(wrong_call) {}
  std::string name() const override { return "wrong once"; }

  Solution solve(const Problem& problem, const Method& method, const Monitor& monitor) override {
    Solution solution = reference_.solve(problem, method, monitor);
    if (++calls_ == wrong_call_) solution.low_rank.segment(0)(0, 0) += 1;
    return solution;
  }

 private:
  ReferenceBackend reference_;
  int wrong_call_, calls_ = 0;
};

inline constexpr Index frames = 20;
inline constexpr std::uint64_t take_bytes = frames * 93 * sizeof(double);  // in an npy file, too

/// Enough for the host to hold `takes` of the takes below at once.
inline std::uint64_t room_for(std::uint64_t takes) { return takes * 8 * take_bytes * 4 / 3; }

/// A job on small takes in a folder of its own, on a backend that is quick, keeps count, and fails
/// on demand.
class SmallRun : public ::testing::Test {
 protected:
  SmallRun() {
    job_.chain = {LowRank{}};
    job_.jobs = 2;
    job_.memory_limit = room_for(1000);
  }

  void write_takes(int count) {
    for (int i = 0; i < count; ++i)
      folder_.write(fmt::format("takes/{:03}.npy", i),
                    synthetic_walk(frames, static_cast<std::uint64_t>(i + 1)));
  }

  // Of the folder `takes`, unless the job has files.
  RunReport run(Backend& backend, const std::stop_token& stop = {}) {
    const std::filesystem::path takes = folder_ / "takes";
    if (job_.files.empty()) job_.files = expand_folders({takes});
    job_.outputs = plan_outputs({.inputs = {takes},
                                 .files = job_.files,
                                 .output = output_,
                                 .outliers = outliers_,
                                 .report = {},
                                 .format = "npy"});
    return run_job(
        job_, backend, [this](const RunEvent& event) { events_.push_back(event); }, stop);
  }

  // Runs on `backend_`, where a stop is requested while it solves for the `call`th time.
  void expect_cancelled_in(std::size_t call) {
    std::stop_source source;
    backend_.before_solving = [&](std::size_t current) {
      if (current == call) source.request_stop();
    };
    EXPECT_THROW(run(backend_, source.get_token()), Cancelled);
  }

  // The takes that events of this kind were about, sorted.
  template <class Kind>
  std::vector<std::size_t> told() const {
    std::vector<std::size_t> takes;
    for (const RunEvent& event : events_)
      if (const auto* kind = std::get_if<Kind>(&event)) takes.push_back(kind->take);
    std::ranges::sort(takes);
    return takes;
  }

  // The last event of this kind; null if there was none.
  template <class Kind>
  const Kind* last_told() const {
    for (auto event = events_.rbegin(); event != events_.rend(); ++event)
      if (const auto* kind = std::get_if<Kind>(&*event)) return kind;
    return nullptr;
  }

  // Everything in the folder that does not belong to the input.
  std::vector<std::string> left_behind() const {
    std::vector<std::string> names = folder_.names();
    std::erase_if(names, [](const std::string& name) { return name.starts_with("takes"); });
    return names;
  }

  TemporaryFolder folder_;
  Job job_;
  std::filesystem::path output_ = folder_ / "clean/deeper", outliers_ = {};
  std::vector<RunEvent> events_;
  ThreeQuarters backend_;
};

}  // namespace moclean::test
