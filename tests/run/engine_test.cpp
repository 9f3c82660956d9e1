// The stages of a run that is all or nothing.

#include "moclean/run/engine.hpp"

#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include "run/small_run.hpp"
#include "support/matrix.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;
using test::frames;
using test::room_for;
using test::take_bytes;
using test::WrongOnce;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

class Engine : public test::SmallRun {};

TEST_F(Engine, GivesEveryFileItsOwnResultInManyBatches) {
  write_takes(40);
  job_.memory_limit = room_for(6);
  outliers_ = folder_ / "outliers";

  const RunReport report = run(backend_);

  EXPECT_GE(report.batches, 20);
  ASSERT_EQ(report.takes.size(), 40u);
  for (int i = 0; i < 40; ++i) {
    const std::string name = fmt::format("{:03}.npy", i);
    const Matrix take = read_recording(folder_ / ("takes/" + name)).samples;
    EXPECT_EQ(report.takes[static_cast<std::size_t>(i)].file.filename(), name);
    EXPECT_EQ(read_recording(folder_ / ("clean/deeper/" + name)).samples, 0.75 * take) << name;
    EXPECT_EQ(read_recording(folder_ / ("outliers/" + name)).samples, 0.25 * take) << name;
  }
}

TEST_F(Engine, ManyTinyTakesShareOneBatch) {
  write_takes(40);

  const RunReport report = run(backend_);

  EXPECT_EQ(report.batches, 1);
  EXPECT_THAT(backend_.calls, ElementsAre(40 * take_bytes));
}

TEST_F(Engine, ABatchEndsWhenTheDeviceIsFull) {
  write_takes(40);
  job_.chain = {LowRank{.segmentation = {.segments = 10}}};  // of each take: 64 and more are full

  const RunReport report = run(backend_);

  EXPECT_EQ(report.batches, 6);
  EXPECT_THAT(backend_.calls, ElementsAre(7 * take_bytes, 7 * take_bytes, 7 * take_bytes,
                                          7 * take_bytes, 7 * take_bytes, 5 * take_bytes));
}

// A job on 40 takes of 10 segments.
class LargeDevice : public Engine {
 protected:
  LargeDevice() {
    write_takes(40);
    job_.chain = {LowRank{.segmentation = {.segments = 10}}};
  }
};

TEST_F(LargeDevice, LeavesFourBatchesToOverlap) {
  backend_.wants.full_segments = 32000;

  EXPECT_EQ(run(backend_).batches, 4);
}

TEST_F(LargeDevice, IsFilledFirstWhereItNeedsMany) {
  backend_.wants = {.least_segments = 160, .full_segments = 640};

  EXPECT_EQ(run(backend_).batches, 3);
}

TEST_F(Engine, NoBatchIsLargerThanItsShareOfTheMemory) {
  write_takes(40);
  job_.memory_limit = room_for(12);

  run(backend_);

  const std::uint64_t copies = 7;  // of the samples, at most, while a batch is solved
  const std::uint64_t host = job_.memory_limit - device_share(job_.memory_limit);
  EXPECT_GE(backend_.calls.size(), 10u);
  EXPECT_THAT(backend_.calls, Each(::testing::Le(static_cast<Index>(host / 3 / copies))));
}

TEST_F(Engine, ATakeThatNeedsAllTheMemoryIsSolvedAlone) {
  write_takes(8);
  folder_.write("takes/004.npy", test::synthetic_walk(3 * frames));
  job_.memory_limit = room_for(3);

  run(backend_);

  EXPECT_THAT(backend_.calls, ::testing::Contains(3 * take_bytes));
  EXPECT_EQ(left_behind().size(), 2 + 8u);  // two folders and the files
}

TEST_F(Engine, ATakeBeyondTheMemoryIsNamedAndLeavesNothing) {
  write_takes(8);
  folder_.write("takes/006.npy", test::synthetic_walk(4 * frames));
  job_.memory_limit = room_for(3);

  EXPECT_THAT([&] { run(backend_); }, ThrowsMessage<FileError>(::testing::AllOf(
                                          HasSubstr("takes/006.npy: needs 406.9 KiB of memory"),
                                          HasSubstr("--memory-limit leaves 348.8 KiB"))));

  EXPECT_GE(backend_.calls.size(), 6u);  // those before it were solved
  EXPECT_THAT(left_behind(), ElementsAre());
}

TEST_F(Engine, AMalformedTakeInTheLastBatchLeavesNothing) {
  write_takes(40);
  folder_.write_text("takes/999.csv", "a,b\n1,2\n3,x\n");
  job_.memory_limit = room_for(6);

  EXPECT_THAT([&] { run(backend_); },
              ThrowsMessage<FileError>(HasSubstr("takes/999.csv:3: expected a number")));

  EXPECT_EQ(backend_.calls.size(), 19u);  // batches of two; the last one was never complete
  EXPECT_THAT(left_behind(), ElementsAre());
}

TEST_F(Engine, ToldOfATakeThatFailsItTellsTheSinkToo) {
  write_takes(2);
  folder_.write_text("takes/999.csv", "a,b\n1,2\n3,x\n");

  EXPECT_THROW(run(backend_), FileError);

  EXPECT_THAT(told<TakeFailed>(), ElementsAre(2));
  EXPECT_THAT(told<TakeWritten>(), ElementsAre());
}

TEST_F(Engine, OfSeveralMalformedTakesTheFirstIsNamed) {
  write_takes(3);
  for (const char* name : {"takes/4.csv", "takes/5.csv", "takes/6.csv"})
    folder_.write_text(name, "a\nx\n");
  job_.jobs = 4;

  EXPECT_THAT([&] { run(backend_); }, ThrowsMessage<FileError>(HasSubstr("takes/4.csv:2")));
}

TEST_F(Engine, AFailingDeviceLeavesNothing) {
  write_takes(40);
  job_.memory_limit = room_for(6);
  backend_.before_solving = [](std::size_t call) {
    if (call == 15) throw DeviceError("lost");
  };

  EXPECT_THROW(run(backend_), DeviceError);

  EXPECT_THAT(left_behind(), ElementsAre());
}

TEST_F(Engine, AStopLeavesNothing) {
  write_takes(40);
  job_.memory_limit = room_for(6);

  expect_cancelled_in(15);

  EXPECT_EQ(backend_.calls.size(), 15u);
  EXPECT_THAT(left_behind(), ElementsAre());
}

TEST_F(Engine, AStopKeepsAFolderThatWasThere) {
  write_takes(2);
  folder_.write_text("clean/earlier.txt", "earlier");

  expect_cancelled_in(1);

  EXPECT_THAT(left_behind(), ElementsAre("clean", "clean/earlier.txt"));
}

TEST_F(Engine, AResultThatCannotBeWrittenLeavesNothing) {
  write_takes(40);
  job_.memory_limit = room_for(3);
  fs::create_directories(folder_ / "clean/deeper/007.npy");

  EXPECT_THAT([&] { run(backend_); },
              ThrowsMessage<FileError>(HasSubstr("007.npy: cannot be written")));

  EXPECT_THAT(left_behind(), ElementsAre("clean", "clean/deeper", "clean/deeper/007.npy"));
}

TEST_F(Engine, ResultsAppearTogetherAtTheEnd) {
  write_takes(40);
  job_.memory_limit = room_for(6);
  std::vector<std::string> early;
  backend_.before_solving = [&](std::size_t call) {
    if (call == 15) early = left_behind();
  };

  run(backend_);

  EXPECT_THAT(early, ::testing::Contains(HasSubstr(".tmp")));
  EXPECT_THAT(early, Not(::testing::Contains(::testing::EndsWith(".npy"))));
  EXPECT_THAT(left_behind(), Not(::testing::Contains(HasSubstr(".tmp"))));
}

TEST_F(Engine, ReadsNoFurtherAheadThanThereIsMemory) {
  write_takes(40);
  job_.memory_limit = room_for(6);
  backend_.before_solving = [&](std::size_t call) {
    if (call > 1) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // enough to read all that is small
    fs::remove(folder_ / "takes/030.npy");
  };

  EXPECT_THAT([&] { run(backend_); },
              ThrowsMessage<FileError>(HasSubstr("030.npy: there is no such file")));
}

TEST_F(Engine, ReadsTheNextTakesWhileTheDeviceWorks) {
  job_.chain = {LowRank{.segmentation = {.length = 1}}};
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
  job_.files = {first, pipe};

  run(backend_);

  EXPECT_EQ(read_recording(folder_ / "clean/deeper/b.npy").samples(0, 0), 0.75);
}

TEST_F(Engine, TellsOfEveryTakeAndOfSegments) {
  write_takes(3);
  ReferenceBackend backend;

  run(backend);

  EXPECT_THAT(told<TakeRead>(), ElementsAre(0, 1, 2));
  EXPECT_THAT(told<TakeWritten>(), ElementsAre(0, 1, 2));
  const auto* last = last_told<SegmentsSolved>();
  ASSERT_TRUE(last);
  EXPECT_EQ(last->task, SolveTask::solving);
  EXPECT_EQ(last->progress.finished, 3);
  EXPECT_EQ(last->progress.total, 3);
  EXPECT_TRUE(last->total_is_exact);
}

TEST_F(Engine, OneStageAfterTheOtherGivesTheSameFiles) {
  write_takes(10);
  job_.memory_limit = room_for(6);
  run(backend_);
  job_.overlap = false;
  output_ = folder_ / "again";

  run(backend_);

  for (int i = 0; i < 10; ++i)
    EXPECT_TRUE(test::content(folder_ / fmt::format("again/{:03}.npy", i)) ==
                test::content(folder_ / fmt::format("clean/deeper/{:03}.npy", i)));
}

TEST_F(Engine, ADifferenceInALaterBatchLeavesNothing) {
  write_takes(8);
  job_.memory_limit = room_for(4);
  job_.verify = true;
  WrongOnce backend(3);

  EXPECT_THAT([&] { run(backend); },
              ThrowsMessage<Error>(
                  ::testing::AllOf(HasSubstr("nothing was written"), HasSubstr("takes/002.npy"))));

  EXPECT_THAT(left_behind(), ElementsAre());
}

TEST_F(Engine, VerifiesEveryBatch) {
  write_takes(8);
  job_.memory_limit = room_for(4);
  job_.verify = true;
  WrongOnce backend(1000);

  const RunReport report = run(backend);

  EXPECT_EQ(report.batches, 8);
  for (const TakeReport& take : report.takes) {
    ASSERT_TRUE(take.verification.has_value());
    EXPECT_EQ(take.verification->agreement.low_rank, 0);
  }
}

TEST_F(Engine, StagesTakeNoLongerThanTheRun) {
  write_takes(10);

  const StageSeconds seconds = run(backend_).seconds;

  for (const double stage : {seconds.read, seconds.solve, seconds.write}) {
    EXPECT_GT(stage, 0);
    EXPECT_LE(stage, seconds.total);
  }
}

}  // namespace
}  // namespace moclean
