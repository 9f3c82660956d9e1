// moclean denoise: which files it reads and writes.

#include <gmock/gmock.h>

#include "moclean/formats/read_write.hpp"

#include "cli/program.hpp"
#include "support/matrix.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Recording narrow_walk(Index frames) {
  Recording walk = synthetic_walk(frames, 9);
  walk.samples.conservativeResize(frames, 12);
  walk.columns.resize(12);
  return walk;
}

TEST(DenoiseFiles, FolderOfTakesGivesTheFilesOfSingleCalls) {
  const TemporaryFolder folder;
  folder.write("takes/a.npy", synthetic_walk(130, 1));
  folder.write("takes/b.csv", synthetic_walk(75, 2));
  folder.write("takes/c.npy", narrow_walk(90));
  folder.write("takes/d.npy", synthetic_walk(20, 3));
  folder.write_text("takes/notes.txt", "not a recording");
  const std::vector<std::string> names = {"a.npy", "b.csv", "c.npy", "d.npy"};

  const Outcome together = run({"denoise", folder / "takes", "-o", folder / "clean/together",
                                "--outliers", folder / "outliers", "--segment-length", "50"});
  ASSERT_EQ(together.exit_code, 0) << together.err;

  for (const std::string& name : names) {
    const Outcome single =
        run({"denoise", folder / ("takes/" + name), "-o", folder / name, "--outliers",
             folder / ("outliers-" + name), "--segment-length", "50"});
    ASSERT_EQ(single.exit_code, 0) << single.err;
    EXPECT_TRUE(content(folder / ("clean/together/" + name)) == content(folder / name));
    EXPECT_TRUE(content(folder / ("outliers/" + name)) == content(folder / ("outliers-" + name)));
  }
}

TEST(DenoiseFiles, GroupingDoesNotChangeTheResults) {
  const TemporaryFolder folder;
  for (int i = 0; i < 8; ++i) {
    folder.write("takes/a" + std::to_string(i) + ".npy",
                 synthetic_walk(90 + 10 * i, static_cast<std::uint64_t>(i + 1)));
    folder.write("takes/b" + std::to_string(i) + ".csv", narrow_walk(40 + i));
  }
  const auto denoise = [&](const std::string& output, std::vector<std::string> options) {
    options.insert(options.begin(), {"denoise", folder / "takes", "-o", folder / output, "--json",
                                     "-", "--segment-length", "40"});
    return run(options);
  };

  const Outcome together = denoise("together", {});
  const Outcome few = denoise("few", {"--memory-limit", "8M"});
  const Outcome apart = denoise("apart", {"--memory-limit", "2M"});
  const Outcome in_turn = denoise("in_turn", {"--no-overlap"});

  EXPECT_EQ(together.json()["groups"], 1);
  EXPECT_GE(few.json()["groups"], 3);
  EXPECT_GE(apart.json()["groups"], 6);
  EXPECT_EQ(in_turn.exit_code, 0) << in_turn.err;
  for (const std::string other : {"few/", "apart/", "in_turn/"})
    for (int i = 0; i < 8; ++i)
      for (const std::string& name :
           {"a" + std::to_string(i) + ".npy", "b" + std::to_string(i) + ".csv"})
        EXPECT_TRUE(content(folder / (other + name)) == content(folder / ("together/" + name)))
            << other << name;
}

TEST(DenoiseFiles, ResultDoesNotDependOnJobs) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("walk.npy", synthetic_walk(160));

  for (const std::string jobs : {"1", "3"})
    ASSERT_EQ(run({"denoise", walk, "-o", folder / (jobs + ".npy"), "--backend", "reference",
                   "--segments", "4", "--jobs", jobs})
                  .exit_code,
              0);

  EXPECT_TRUE(content(folder / "1.npy") == content(folder / "3.npy"));
}

TEST(DenoiseFiles, FramesGiveTheResultOfTheCutRecording) {
  const TemporaryFolder folder;
  const Recording walk = synthetic_walk(120);
  const std::string whole = folder.write("walk.npy", walk);
  const std::string part = folder.write("part.npy", excerpt(walk, 30, 120));

  ASSERT_EQ(run({"denoise", whole, "-o", folder / "a.npy", "--frames", "30:"}).exit_code, 0);
  ASSERT_EQ(run({"denoise", part, "-o", folder / "b.npy"}).exit_code, 0);

  EXPECT_TRUE(content(folder / "a.npy") == content(folder / "b.npy"));
}

TEST(DenoiseFiles, FormatNamesTheFilesInAFolder) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("walk.npy", narrow_walk(20));

  const Outcome outcome = run({"denoise", walk, "-o", folder / "clean/", "--format", "csv"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(folder.names(),
              ElementsAre("clean", "clean/moclean.manifest.jsonl", "clean/walk.csv", "walk.npy"));
}

TEST(DenoiseFiles, RateAndNamesReachTheResult) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("walk.csv", narrow_walk(20));

  ASSERT_EQ(run({"denoise", walk, "-o", folder / "clean.csv"}).exit_code, 0);

  const Recording clean = read_recording(folder / "clean.csv");
  EXPECT_EQ(clean.columns, narrow_walk(20).columns);
  EXPECT_EQ(clean.frame_rate, 120);
}

TEST(DenoiseFiles, MayReplaceItsInputByForce) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("walk.npy", narrow_walk(20));
  ASSERT_EQ(run({"denoise", walk, "-o", folder / "clean.npy"}).exit_code, 0);

  ASSERT_EQ(run({"denoise", walk, "-o", walk, "--force"}).exit_code, 0);

  EXPECT_TRUE(content(walk) == content(folder / "clean.npy"));
  EXPECT_THAT(folder.names(), ElementsAre("clean.npy", "walk.npy"));
}

TEST(DenoiseFiles, SameResultTwiceIsAUsageError) {
  const TemporaryFolder folder;
  const std::string csv = folder.write("walk.csv", narrow_walk(20));
  const std::string npy = folder.write("walk.npy", narrow_walk(20));

  const Outcome outcome = run({"denoise", csv, npy, "-o", folder / "clean", "--format", "csv"});

  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr(csv), HasSubstr(npy)));
  EXPECT_THAT(folder.names(), ElementsAre("walk.csv", "walk.npy"));
}

TEST(DenoiseFiles, SameFileForMotionAndOutliersIsAUsageError) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("walk.npy", narrow_walk(20));

  const Outcome outcome =
      run({"denoise", walk, "-o", folder / "clean.npy", "--outliers", folder / "./clean.npy"});

  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("would both write"));
}

TEST(DenoiseFiles, SeveralInputsNeedAFolder) {
  const TemporaryFolder folder;
  const std::string a = folder.write("a.npy", narrow_walk(20));
  const std::string b = folder.write("b.npy", narrow_walk(20));
  const std::string file = folder.write_text("clean.npy", "earlier");

  const Outcome outcome = run({"denoise", a, b, "-o", file});

  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("is a file"));
  EXPECT_EQ(content(file), "earlier");
}

TEST(DenoiseFiles, OneMalformedInputStopsAllOrNothingBeforeAnythingIsWritten) {
  const TemporaryFolder folder;
  const std::string good = folder.write("good.csv", narrow_walk(20));
  const std::string bad = folder.write_text("bad.csv", "a,b\n1,2\n3,x\n");

  const Outcome outcome = run({"denoise", good, bad, "-o", folder / "clean", "--all-or-nothing"});

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, StartsWith("moclean: " + bad + ":3: "));
  EXPECT_THAT(folder.names(), ElementsAre("bad.csv", "good.csv"));
}

TEST(DenoiseFiles, MissingSampleIsNamedByFileFrameAndColumn) {
  const TemporaryFolder folder;
  const std::string good = folder.write("a.csv", narrow_walk(20));
  Recording gap = narrow_walk(20);
  gap.samples(7, 4) = std::nan("");
  const std::string bad = folder.write("b.csv", gap);

  const Outcome outcome = run({"denoise", good, bad, "-o", folder / "clean", "--frames",
                               "5:", "--method", "tsvd:rank=2", "--all-or-nothing"});

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr(bad + ": frame 7, column joint1.y is nan"));
  EXPECT_THAT(folder.names(), ElementsAre("a.csv", "b.csv"));
}

struct Refused {
  const char* name;
  std::vector<std::string> input_and_output;  ///< in the temporary folder
  int exit_code;
  const char* message;
};

void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.name; }

class RefusedFiles : public ::testing::TestWithParam<Refused> {};

TEST_P(RefusedFiles, AreNamedBeforeAnythingIsSolved) {
  const TemporaryFolder folder;
  folder.write("walk.csv", narrow_walk(20));
  folder.write_text("notes/notes.txt", "not a recording");
  const std::string& input = GetParam().input_and_output[0];
  const std::string& output = GetParam().input_and_output[1];

  // The device does not exist: whoever gets as far as opening it reports that instead.
  const Outcome outcome =
      run({"denoise", folder / input, "-o", folder / output, "--device", "abacus"});

  EXPECT_EQ(outcome.exit_code, GetParam().exit_code);
  EXPECT_THAT(outcome.err, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Files, RefusedFiles,
    ::testing::Values(
        Refused{"MissingInput", {"none.csv", "clean.csv"}, 1, "there is no such file"},
        Refused{"FolderWithoutRecordings", {"notes", "clean"}, 1, "holds no recording"},
        Refused{"SkeletonOutput",
                {"walk.csv", "clean.bvh"},
                2,
                "own skeleton, expected .c3d, .trc, .csv, .tsv, .txt, .mot, .sto, .npy or .npz"},
        Refused{"OutputWithoutExtension",
                {"walk.csv", "clean"},
                2,
                "expected .bvh, .amc, .c3d, .trc, .csv, .tsv, .txt, .mot, .sto, .npy or .npz"},
        Refused{"NoFolderForOutput", {"walk.csv", "none/clean.csv"}, 1, "there is no folder"},
        Refused{"FileAsFolder", {"walk.csv", "walk.csv/"}, 2, "is a file"}),
    [](const auto& test) { return test.param.name; });

TEST(Records, ReplaceNothingThatIsReadOrWritten) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("walk.csv", synthetic_walk(20));
  const std::string before = content(walk);
  const auto denoise = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"denoise", walk, "-o", folder / "clean.csv", "--method", "median"});
    return run(more);
  };

  for (const char* option : {"--json", "--lines"}) {
    EXPECT_EQ(denoise({option, walk}).exit_code, 2) << option;
    EXPECT_EQ(denoise({option, folder / "clean.csv"}).exit_code, 2) << option;
    EXPECT_EQ(
        denoise({option, folder / "t.csv", "--truth", folder.write("t.csv", synthetic_walk(20))})
            .exit_code,
        2)
        << option;
  }
  EXPECT_EQ(denoise({"--json", folder / "r", "--lines", folder / "r"}).exit_code, 2);
  EXPECT_EQ(content(walk), before);
  EXPECT_THAT(folder.names(), ElementsAre("t.csv", "walk.csv"));
}

}  // namespace
}  // namespace moclean::test
