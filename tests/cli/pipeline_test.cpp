// The stages of `moclean denoise` with a backend that is quick, keeps count, and fails on demand.

#include "cli/commands/pipeline.hpp"

#include <functional>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/read_write.hpp"
#include "moclean/run/memory_budget.hpp"
#include "moclean/solve/reference/reference_backend.hpp"

#include "cli/program.hpp"
#include "support/matrix.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean::cli {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

// Takes three quarters of every sample as motion.
class ThreeQuarters final : public Backend {
 public:
  std::string name() const override { return "three quarters"; }

  Solution solve(const SegmentBatch& data, const Method&, const Monitor& monitor) override {
    calls.push_back(data.rows() * data.columns() * Index{sizeof(double)});
    before_solving(calls.size());
    if (monitor.stop.stop_requested()) throw Cancelled();
    Solution solution{data, data,
                      std::vector<SegmentOutcome>(static_cast<std::size_t>(data.segments()))};
    for (double& sample : solution.low_rank.storage()) sample *= 0.75;
    for (double& sample : solution.sparse.storage()) sample *= 0.25;
    return solution;
  }

  std::vector<Index> calls;  ///< bytes of samples of each
  std::function<void(std::size_t call)> before_solving = [](std::size_t) {};
};

// The device of --verify: right, but for one call.
class WrongOnce final : public Backend {
 public:
  explicit WrongOnce(int wrong_call) : wrong_call_(wrong_call) {}
  std::string name() const override { return "wrong once"; }

  Solution solve(const SegmentBatch& data, const Method& method, const Monitor& monitor) override {
    Solution solution = reference_.solve(data, method, monitor);
    if (++calls_ == wrong_call_) solution.low_rank.segment(0)(0, 0) += 1;
    return solution;
  }

 private:
  ReferenceBackend reference_;
  int wrong_call_, calls_ = 0;
};

constexpr Index frames = 20, columns = 93;
constexpr std::uint64_t take_bytes = frames * columns * sizeof(double);  // in an npy file, too

// Enough for the host to hold `takes` of the takes below at once.
std::uint64_t room_for(std::uint64_t takes) { return takes * 8 * take_bytes * 4 / 3; }

class Pipeline : public ::testing::Test {
 protected:
  Pipeline() {
    options_.quiet = true;
    options_.jobs = 2;
    options_.memory_limit = room_for(1000);
    options_.output = folder_ / "clean/deeper";
  }

  void write_takes(int count) {
    for (int i = 0; i < count; ++i)
      folder_.write(fmt::format("takes/{:03}.npy", i),
                    test::synthetic_walk(frames, static_cast<std::uint64_t>(i + 1)));
  }

  Job job() {
    options_.inputs = {folder_ / "takes"};
    Job found{.options = options_, .files = expand_folders(options_.inputs), .plan = {}};
    found.plan = plan_outputs({.inputs = options_.inputs,
                               .files = found.files,
                               .output = options_.output,
                               .outliers = options_.outliers,
                               .report = {},
                               .format = options_.format});
    return found;
  }

  RunReport run(Backend& backend, const std::stop_token& stop = {}) {
    return run_pipeline(job(), backend, stop);
  }

  // Everything in the folder that does not belong to the input.
  std::vector<std::string> left_behind() const {
    std::vector<std::string> names = folder_.names();
    std::erase_if(names, [](const std::string& name) { return name.starts_with("takes"); });
    return names;
  }

  TemporaryFolder folder_;
  DenoiseOptions options_;
  ThreeQuarters backend_;
};

TEST_F(Pipeline, GivesEveryFileItsOwnResultInManyGroups) {
  write_takes(40);
  options_.memory_limit = room_for(6);
  options_.outliers = folder_ / "outliers";

  const RunReport report = run(backend_);

  EXPECT_GE(report.groups, 20);
  ASSERT_EQ(report.takes.size(), 40u);
  for (int i = 0; i < 40; ++i) {
    const std::string name = fmt::format("{:03}.npy", i);
    const Matrix take = read_clip(folder_ / ("takes/" + name)).samples;
    EXPECT_EQ(report.takes[static_cast<std::size_t>(i)].file.filename(), name);
    EXPECT_EQ(read_clip(folder_ / ("clean/deeper/" + name)).samples, 0.75 * take) << name;
    EXPECT_EQ(read_clip(folder_ / ("outliers/" + name)).samples, 0.25 * take) << name;
  }
}

TEST_F(Pipeline, ManyTinyTakesShareOneBatch) {
  write_takes(40);

  const RunReport report = run(backend_);

  EXPECT_EQ(report.groups, 1);
  EXPECT_THAT(backend_.calls, ElementsAre(40 * take_bytes));
}

TEST_F(Pipeline, AGroupEndsWhenTheDeviceIsFull) {
  write_takes(40);
  options_.chain = {
      LowRank{.segmentation = {.segments = 10}}};  // of each take: 64 and more are full

  const RunReport report = run(backend_);

  EXPECT_EQ(report.groups, 6);
  EXPECT_THAT(backend_.calls, ElementsAre(7 * take_bytes, 7 * take_bytes, 7 * take_bytes,
                                          7 * take_bytes, 7 * take_bytes, 5 * take_bytes));
}

// A job on 40 takes of 10 segments.
class LargeDevice : public Pipeline {
 protected:
  LargeDevice() {
    write_takes(40);
    options_.chain = {LowRank{.segmentation = {.segments = 10}}};
  }
};

TEST_F(LargeDevice, LeavesFourGroupsToOverlap) {
  Job large = job();
  large.compute_units = 1000;

  EXPECT_EQ(run_pipeline(large, backend_).groups, 4);
}

TEST_F(LargeDevice, IsFilledFirstWhereItIsAGpu) {
  Job large = job();
  large.on_gpu = true;
  large.compute_units = 20;  // 160 segments, 16 takes

  EXPECT_EQ(run_pipeline(large, backend_).groups, 3);
}

TEST_F(Pipeline, NoGroupIsLargerThanItsShareOfTheMemory) {
  write_takes(40);
  options_.memory_limit = room_for(12);

  run(backend_);

  const std::uint64_t copies = 7;  // of the samples, at most, while a group is solved
  const std::uint64_t host = options_.memory_limit - device_share(options_.memory_limit);
  EXPECT_GE(backend_.calls.size(), 10u);
  EXPECT_THAT(backend_.calls, Each(::testing::Le(static_cast<Index>(host / 3 / copies))));
}

TEST_F(Pipeline, ATakeThatNeedsAllTheMemoryIsSolvedAlone) {
  write_takes(8);
  folder_.write("takes/004.npy", test::synthetic_walk(3 * frames));
  options_.memory_limit = room_for(3);

  run(backend_);

  EXPECT_THAT(backend_.calls, ::testing::Contains(3 * take_bytes));
  EXPECT_EQ(left_behind().size(), 2 + 8u);  // two folders and the files
}

TEST_F(Pipeline, ATakeBeyondTheMemoryIsNamedAndLeavesNothing) {
  write_takes(8);
  folder_.write("takes/006.npy", test::synthetic_walk(4 * frames));
  options_.memory_limit = room_for(3);

  EXPECT_THAT([&] { run(backend_); }, ThrowsMessage<FileError>(::testing::AllOf(
                                          HasSubstr("takes/006.npy: needs 406.9 KiB of memory"),
                                          HasSubstr("--memory-limit leaves 348.8 KiB"))));

  EXPECT_GE(backend_.calls.size(), 6u);  // those before it were solved
  EXPECT_THAT(left_behind(), ElementsAre());
}

TEST_F(Pipeline, AMalformedTakeInTheLastGroupLeavesNothing) {
  write_takes(40);
  folder_.write_text("takes/999.csv", "a,b\n1,2\n3,x\n");
  options_.memory_limit = room_for(6);

  EXPECT_THAT([&] { run(backend_); },
              ThrowsMessage<FileError>(HasSubstr("takes/999.csv:3: expected a number")));

  EXPECT_EQ(backend_.calls.size(), 19u);  // groups of two; the last one was never complete
  EXPECT_THAT(left_behind(), ElementsAre());
}

TEST_F(Pipeline, OfSeveralMalformedTakesTheFirstIsNamed) {
  write_takes(3);
  for (const char* name : {"takes/4.csv", "takes/5.csv", "takes/6.csv"})
    folder_.write_text(name, "a\nx\n");
  options_.jobs = 4;

  EXPECT_THAT([&] { run(backend_); }, ThrowsMessage<FileError>(HasSubstr("takes/4.csv:2")));
}

TEST_F(Pipeline, AFailingDeviceLeavesNothing) {
  write_takes(40);
  options_.memory_limit = room_for(6);
  backend_.before_solving = [](std::size_t call) {
    if (call == 15) throw DeviceError("lost");
  };

  EXPECT_THROW(run(backend_), DeviceError);

  EXPECT_THAT(left_behind(), ElementsAre());
}

TEST_F(Pipeline, AStopLeavesNothing) {
  write_takes(40);
  options_.memory_limit = room_for(6);
  std::stop_source source;
  backend_.before_solving = [&](std::size_t call) {
    if (call == 15) source.request_stop();
  };

  EXPECT_THROW(run(backend_, source.get_token()), Cancelled);

  EXPECT_EQ(backend_.calls.size(), 15u);
  EXPECT_THAT(left_behind(), ElementsAre());
}

TEST_F(Pipeline, AStopKeepsAFolderThatWasThere) {
  write_takes(2);
  folder_.write_text("clean/earlier.txt", "earlier");
  std::stop_source source;
  backend_.before_solving = [&](std::size_t) { source.request_stop(); };

  EXPECT_THROW(run(backend_, source.get_token()), Cancelled);

  EXPECT_THAT(left_behind(), ElementsAre("clean", "clean/earlier.txt"));
}

TEST_F(Pipeline, AResultThatCannotBeWrittenLeavesNothing) {
  write_takes(40);
  options_.memory_limit = room_for(3);
  fs::create_directories(folder_ / "clean/deeper/007.npy");

  EXPECT_THAT([&] { run(backend_); },
              ThrowsMessage<FileError>(HasSubstr("007.npy: cannot be written")));

  EXPECT_THAT(left_behind(), ElementsAre("clean", "clean/deeper", "clean/deeper/007.npy"));
}

TEST_F(Pipeline, ResultsAppearTogetherAtTheEnd) {
  write_takes(40);
  options_.memory_limit = room_for(6);
  std::vector<std::string> early;
  backend_.before_solving = [&](std::size_t call) {
    if (call == 15) early = left_behind();
  };

  run(backend_);

  EXPECT_THAT(early, ::testing::Contains(HasSubstr(".tmp")));
  EXPECT_THAT(early, Not(::testing::Contains(::testing::EndsWith(".npy"))));
  EXPECT_THAT(left_behind(), Not(::testing::Contains(HasSubstr(".tmp"))));
}

TEST_F(Pipeline, ReadsNoFurtherAheadThanThereIsMemory) {
  write_takes(40);
  options_.memory_limit = room_for(6);
  backend_.before_solving = [&](std::size_t call) {
    if (call > 1) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // enough to read all that is small
    fs::remove(folder_ / "takes/030.npy");
  };

  EXPECT_THAT([&] { run(backend_); },
              ThrowsMessage<FileError>(HasSubstr("030.npy: there is no such file")));
}

TEST_F(Pipeline, ReadsTheNextTakesWhileTheDeviceWorks) {
  options_.chain = {LowRank{.segmentation = {.length = 1}}};
  const std::string first = folder_.write("takes/a.npy", test::synthetic_walk(100));
  const std::string pipe = folder_ / "takes/b.csv";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  bool read_meanwhile = false;
  backend_.before_solving = [&](std::size_t call) {
    // A pipe can be opened for writing without waiting once somebody reads from it.
    for (int i = 0; call == 1 && i < 5000 && !read_meanwhile; ++i) {
      const int file = open(pipe.c_str(), O_WRONLY | O_NONBLOCK);
      read_meanwhile = file >= 0 && write(file, "a\n1\n", 4) == 4;
      if (file >= 0) close(file);
      usleep(1000);
    }
    if (!read_meanwhile) throw DeviceError("nobody reads the pipe");
  };
  options_.inputs = {first, pipe};
  Job job{.options = options_, .files = options_.inputs, .plan = {}};
  job.plan = plan_outputs({.inputs = options_.inputs,
                           .files = job.files,
                           .output = options_.output,
                           .outliers = {},
                           .report = {},
                           .format = "npy"});

  run_pipeline(job, backend_);

  EXPECT_EQ(read_clip(folder_ / "clean/deeper/b.npy").samples(0, 0), 0.75);
}

TEST_F(Pipeline, OneStageAfterTheOtherGivesTheSameFiles) {
  write_takes(10);
  options_.memory_limit = room_for(6);
  run(backend_);
  options_.overlap = false;
  options_.output = folder_ / "again";

  run(backend_);

  for (int i = 0; i < 10; ++i)
    EXPECT_TRUE(test::content(folder_ / fmt::format("again/{:03}.npy", i)) ==
                test::content(folder_ / fmt::format("clean/deeper/{:03}.npy", i)));
}

TEST_F(Pipeline, ADifferenceInALaterGroupLeavesNothing) {
  write_takes(8);
  options_.memory_limit = room_for(4);
  options_.verify = true;
  WrongOnce backend(3);

  EXPECT_THAT([&] { run(backend); },
              ThrowsMessage<Error>(
                  ::testing::AllOf(HasSubstr("nothing was written"), HasSubstr("takes/002.npy"))));

  EXPECT_THAT(left_behind(), ElementsAre());
}

TEST_F(Pipeline, VerifiesEveryGroup) {
  write_takes(8);
  options_.memory_limit = room_for(4);
  options_.verify = true;
  WrongOnce backend(1000);

  const RunReport report = run(backend);

  EXPECT_EQ(report.groups, 8);
  for (const TakeReport& take : report.takes) {
    ASSERT_TRUE(take.verification.has_value());
    EXPECT_EQ(take.verification->agreement.low_rank, 0);
  }
}

TEST_F(Pipeline, StagesTakeNoLongerThanTheRun) {
  write_takes(10);

  const StageSeconds seconds = run(backend_).seconds;

  for (const double stage : {seconds.read, seconds.solve, seconds.write}) {
    EXPECT_GT(stage, 0);
    EXPECT_LE(stage, seconds.total);
  }
}

}  // namespace
}  // namespace moclean::cli
