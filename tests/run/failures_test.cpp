// Takes that fail in a run where each take stands on its own.

#include <gmock/gmock.h>

#include "run/small_run.hpp"
#include "support/matrix.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;
using test::frames;
using test::room_for;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class EachOnItsOwn : public test::SmallRun {
 protected:
  EachOnItsOwn() { job_.on_failure = FailurePolicy::each_on_its_own; }

  std::vector<std::string> failures(const RunReport& report) const {
    std::vector<std::string> found;
    for (const TakeReport& take : report.takes) found.push_back(take.failure);
    return found;
  }

  // What is left but the takes and the folder of results.
  std::vector<std::string> results() const {
    std::vector<std::string> names = left_behind();
    std::erase_if(names,
                  [](const std::string& name) { return !name.starts_with("clean/deeper/"); });
    return names;
  }
};

TEST_F(EachOnItsOwn, ABadFileInTheMiddleLeavesTheOthersTheirResults) {
  write_takes(3);
  folder_.write_text("takes/001.csv", "a,b\n1,2\n3,x\n");
  job_.files = {folder_ / "takes/000.npy", folder_ / "takes/001.csv", folder_ / "takes/002.npy"};

  const RunReport report = run(backend_);

  EXPECT_THAT(failures(report),
              ElementsAre("", HasSubstr("takes/001.csv:3: expected a number"), ""));
  EXPECT_EQ(report.batches, 1);
  EXPECT_THAT(results(), ElementsAre("clean/deeper/000.npy", "clean/deeper/002.npy"));
  for (const char* name : {"000.npy", "002.npy"})
    EXPECT_EQ(read_recording(folder_ / fmt::format("clean/deeper/{}", name)).samples,
              0.75 * read_recording(folder_ / fmt::format("takes/{}", name)).samples);
  EXPECT_THAT(told<TakeRead>(), ElementsAre(0, 2));
  EXPECT_THAT(told<TakeFailed>(), ElementsAre(1));
  EXPECT_THAT(told<TakeWritten>(), ElementsAre(0, 2));
}

TEST_F(EachOnItsOwn, ATakeThatTheMethodRefusesLeavesItsBatch) {
  for (const char* name : {"takes/a.npy", "takes/c.npy"}) {
    Recording walk = test::synthetic_walk(60);
    walk.samples.conservativeResize(60, 9);
    walk.columns.resize(9);
    folder_.write(name, walk);
  }
  folder_.write("takes/b.npy", {test::random_matrix(60, 9, 1), default_column_names(9), 0, {}});
  job_.chain = {Automatic{}};
  ReferenceBackend backend;

  const RunReport report = run(backend);

  EXPECT_THAT(failures(report), ElementsAre("", HasSubstr("takes/b.npy: its rows are not"), ""));
  EXPECT_THAT(results(), ElementsAre("clean/deeper/a.npy", "clean/deeper/c.npy"));
  EXPECT_TRUE(test::content(folder_ / "clean/deeper/a.npy") ==
              test::content(folder_ / "clean/deeper/c.npy"));
}

TEST_F(EachOnItsOwn, WhatTheDeviceCannotSolveTogetherItSolvesAlone) {
  write_takes(3);
  backend_.before_solving = [](std::size_t call) {
    if (call == 1) throw DeviceError("out of memory");
  };

  const RunReport report = run(backend_);

  EXPECT_THAT(failures(report), ElementsAre("", "", ""));
  EXPECT_EQ(backend_.calls.size(), 4u);
  EXPECT_EQ(results().size(), 3u);
}

TEST_F(EachOnItsOwn, ATakeThatTheDeviceCannotSolveFailsAlone) {
  write_takes(3);
  backend_.before_solving = [](std::size_t call) {
    if (call == 1 || call == 3) throw DeviceError("out of memory");
  };

  const RunReport report = run(backend_);

  EXPECT_THAT(failures(report), ElementsAre("", HasSubstr("takes/001.npy: out of memory"), ""));
  EXPECT_THAT(results(), ElementsAre("clean/deeper/000.npy", "clean/deeper/002.npy"));
}

TEST_F(EachOnItsOwn, AResultThatCannotBeWrittenLeavesTheOthers) {
  write_takes(3);
  fs::create_directories(folder_ / "clean/deeper/001.npy/inside");

  const RunReport report = run(backend_);

  EXPECT_THAT(failures(report), ElementsAre("", HasSubstr("001.npy: cannot be written"), ""));
  EXPECT_THAT(told<TakeWritten>(), ElementsAre(0, 2));
  EXPECT_THAT(results(), ElementsAre("clean/deeper/000.npy", "clean/deeper/001.npy",
                                     "clean/deeper/001.npy/inside", "clean/deeper/002.npy"));
}

TEST_F(EachOnItsOwn, ATruthOfAnotherShapeFailsItsTake) {
  write_takes(3);
  for (int i = 0; i < 3; ++i)
    job_.truths.push_back(folder_.write(fmt::format("truth/{}.npy", i),
                                        test::synthetic_walk(i == 1 ? frames + 1 : frames)));

  const RunReport report = run(backend_);

  EXPECT_THAT(failures(report), ElementsAre("", HasSubstr("the truth has 21 frames"), ""));
  EXPECT_TRUE(report.takes[2].truth.has_value());
  EXPECT_EQ(results().size(), 2u);
}

TEST_F(EachOnItsOwn, ADifferenceToTheReferenceFailsItsTake) {
  write_takes(4);
  job_.memory_limit = room_for(4);  // each take a batch
  job_.verify = true;
  test::WrongOnce backend(3);

  const RunReport report = run(backend);

  EXPECT_THAT(
      failures(report),
      ElementsAre("", "", StartsWith("not verified, not written: " + folder_ / "takes/002"), ""));
  EXPECT_THAT(told<TakeWritten>(), ElementsAre(0, 1, 3));
}

TEST_F(EachOnItsOwn, ATakeBeyondTheMemoryFailsAlone) {
  write_takes(3);
  folder_.write("takes/001.npy", test::synthetic_walk(4 * frames));
  job_.memory_limit = room_for(3);

  const RunReport report = run(backend_);

  EXPECT_THAT(failures(report), ElementsAre("", HasSubstr("001.npy: needs 406.9 KiB"), ""));
  EXPECT_EQ(results().size(), 2u);
}

TEST_F(EachOnItsOwn, AResultAppearsWhenItsTakeIsDone) {
  write_takes(40);
  job_.memory_limit = room_for(6);
  std::vector<std::string> early;
  backend_.before_solving = [&](std::size_t call) {
    if (call == 15) early = left_behind();
  };

  run(backend_);

  EXPECT_THAT(early, Contains("clean/deeper/000.npy"));
  EXPECT_EQ(results().size(), 40u);
}

TEST_F(EachOnItsOwn, AStopKeepsWhatWasWritten) {
  write_takes(40);
  job_.memory_limit = room_for(6);

  expect_cancelled_in(15);

  EXPECT_FALSE(told<TakeWritten>().empty());
  EXPECT_EQ(results().size(), told<TakeWritten>().size());
}

TEST_F(EachOnItsOwn, WhereAllFailNothingIsLeft) {
  for (const char* name : {"takes/1.csv", "takes/2.csv"}) folder_.write_text(name, "a\nx\n");

  const RunReport report = run(backend_);

  EXPECT_THAT(failures(report), ElementsAre(HasSubstr("1.csv:2"), HasSubstr("2.csv:2")));
  EXPECT_EQ(report.batches, 0);
  EXPECT_THAT(left_behind(), IsEmpty());
}

TEST_F(EachOnItsOwn, WithoutOverlapTheSameTakesFail) {
  write_takes(3);
  folder_.write_text("takes/003.csv", "a\nx\n");
  job_.overlap = false;

  const RunReport report = run(backend_);

  EXPECT_THAT(failures(report), ElementsAre("", "", "", HasSubstr("003.csv:2")));
  EXPECT_EQ(results().size(), 3u);
}

}  // namespace
}  // namespace moclean
