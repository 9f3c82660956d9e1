// moclean denoise: folders of takes, failures among them, what is printed and recorded.

#include <array>

#include <gmock/gmock.h>

#include "moclean/formats/formats.hpp"
#include "moclean/formats/read_write.hpp"

#include "cli/batch_folder.hpp"
#include "support/matrix.hpp"

namespace moclean::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* damaged = "a,b\n1,2\n3,x\n";

TEST(Batch, ATreeOfTakesComesBackWithItsPathsNamesAndFormats) {
  const TemporaryFolder folder;
  folder.write_text("in/actor1/walk.bvh", std::string(tiny_bvh));
  folder.write("in/actor1/slow/run.c3d", small_walk(30));
  folder.write("in/actor2/jump.trc", small_walk(31));
  folder.write("in/turn.csv", small_walk(32));
  folder.write("in/sit.npy", small_walk(33));
  folder.write_text("in/readme.txt", "notes");

  const Outcome outcome = denoise_quickly({folder / "in", "-o", folder / "out"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(files_below(folder, "out"),
              ElementsAre("actor1/slow/run.c3d", "actor1/walk.bvh", "actor2/jump.trc",
                          "moclean.manifest.jsonl", "sit.npy", "turn.csv"));
  EXPECT_TRUE(read_recording(folder / "out/actor1/walk.bvh").skeleton.has_value());
}

TEST(Batch, FailedTakesAreNamedAtTheEndAndTheOthersAreWritten) {
  const TemporaryFolder folder;
  for (const char* name : {"in/a.csv", "in/c.csv", "in/d/e.npy"})
    folder.write(name, small_walk(30));
  const std::string bad = folder.write_text("in/b.csv", damaged);
  const std::string cut = folder.write_text("in/d/cut.c3d", "\x02P");

  const Outcome outcome = denoise_quickly({folder / "in", "-o", folder / "out", "--json",
                                           folder / "run.json", "--lines", folder / "run.jsonl"});

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(files_below(folder, "out"),
              ElementsAre("a.csv", "c.csv", "d/e.npy", "moclean.manifest.jsonl"));
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("moclean: " + bad + ":3: expected a number"),
                                 HasSubstr("moclean: " + cut + ": "),
                                 EndsWith("moclean: 2 of 5 takes failed, see above\n")));
  EXPECT_THAT(outcome.out, HasSubstr("takes    3 done, 2 failed, 0 left out"));
  const auto record = nlohmann::json::parse(content(folder / "run.json"));
  EXPECT_THAT(record["inputs"][1]["error"].get<std::string>(), HasSubstr("b.csv:3: "));
  EXPECT_FALSE(record["inputs"][0].contains("error"));
  const auto lines = lines_of(content(folder / "run.jsonl"));
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(std::ranges::count_if(lines, [](const auto& l) { return l.contains("error"); }), 2);
}

TEST(Batch, AllOrNothingWritesNothingWhereATakeFails) {
  const TemporaryFolder folder;
  folder.write("in/a.csv", small_walk(30));
  const std::string bad = folder.write_text("in/b.csv", damaged);

  const Outcome outcome =
      denoise_quickly({folder / "in", "-o", folder / "out", "--all-or-nothing"});

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, StartsWith("moclean: " + bad + ":3: "));
  EXPECT_THAT(folder.names(), ElementsAre("in", "in/a.csv", "in/b.csv"));
}

TEST(Batch, WhereEveryTakeFailsNothingIsLeft) {
  const TemporaryFolder folder;
  folder.write_text("in/a.csv", damaged);
  folder.write_text("in/b.csv", damaged);

  const Outcome outcome = denoise_quickly({folder / "in", "-o", folder / "out"});

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(folder.names(), ElementsAre("in", "in/a.csv", "in/b.csv"));
}

TEST(Batch, ResultsOfEarlierRunsBelowTheTakesAreNoTakes) {
  const TemporaryFolder folder;
  folder.write("in/walk.csv", small_walk(30));
  const std::vector<std::string> arguments = {folder / "in", "-o", folder / "in/clean", "--mask",
                                              folder / "in/masks"};
  ASSERT_EQ(denoise_quickly(arguments).exit_code, 0);
  const auto first = files_below(folder, "in");

  ASSERT_EQ(denoise_quickly(arguments).exit_code, 0);
  EXPECT_EQ(files_below(folder, "in"), first);

  // Also those of a run into another folder.
  ASSERT_EQ(denoise_quickly({folder / "in", "-o", folder / "in/other"}).exit_code, 0);
  EXPECT_THAT(files_below(folder, "in/other"), ElementsAre("moclean.manifest.jsonl", "walk.csv"));
  ASSERT_EQ(denoise_quickly({folder / "in", "-o", folder / "out"}).exit_code, 0);
  EXPECT_THAT(files_below(folder, "out"),
              ::testing::Not(::testing::Contains(StartsWith("clean/"))));

  // But they are where they are given themselves.
  ASSERT_EQ(denoise_quickly({folder / "in/clean", "-o", folder / "again"}).exit_code, 0);
  EXPECT_THAT(files_below(folder, "again"), ElementsAre("moclean.manifest.jsonl", "walk.csv"));
}

TEST(Batch, KeepRawPutsEveryInputBesideItsResult) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("in/a/walk.csv", small_walk(30));

  ASSERT_EQ(denoise_quickly({folder / "in", "-o", folder / "out", "--keep-raw"}).exit_code, 0);

  EXPECT_THAT(files_below(folder, "out"),
              ElementsAre("a/walk.csv", "a/walk.raw.csv", "moclean.manifest.jsonl"));
  EXPECT_EQ(content(folder / "out/a/walk.raw.csv"), content(walk));
}

TEST(Batch, KeepRawInTheSameFolderCleansTheKeptInputEveryTime) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("in/walk.csv", small_walk(30));
  const std::string original = content(walk);
  ASSERT_EQ(denoise_quickly({folder / "in", "-o", folder / "out"}).exit_code, 0);

  for (int turn = 0; turn < 2; ++turn) {
    const Outcome outcome = denoise_quickly({folder / "in", "-o", folder / "in", "--keep-raw"});

    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(content(walk), content(folder / "out/walk.csv"));
    EXPECT_EQ(content(folder / "in/walk.raw.csv"), original);
  }

  // A newer input is not taken for a result.
  folder.write("in/walk.csv", small_walk(31));
  const Outcome newer = denoise_quickly({folder / "in", "-o", folder / "in", "--keep-raw"});
  EXPECT_EQ(newer.exit_code, 2);
  EXPECT_THAT(newer.err, HasSubstr("walk.raw.csv was kept of an earlier walk.csv"));
  EXPECT_EQ(content(folder / "in/walk.raw.csv"), original);
}

TEST(Batch, AnInputIsReplacedOnlyByForce) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("in/walk.csv", small_walk(30));
  const std::string original = content(walk);
  fs::create_symlink(walk, folder / "link.csv");

  for (const std::vector<std::string>& arguments :
       {std::vector{walk, std::string("-o"), walk},
        std::vector{walk, std::string("-o"), folder / "link.csv"},
        std::vector{folder / "in", std::string("-o"), folder / "in"}}) {
    const Outcome refused = denoise_quickly(arguments);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, AllOf(HasSubstr("is an input"), HasSubstr("--force")));
    EXPECT_EQ(content(walk), original);
  }
  EXPECT_EQ(denoise_quickly({folder / "in", "-o", folder / "in", "--force"}).exit_code, 0);
  EXPECT_NE(content(walk), original);
}

TEST(Batch, SeveralInputsNeedNoFileAsOutput) {
  const TemporaryFolder folder;
  const std::string a = folder.write("a.csv", small_walk(30)),
                    b = folder.write("b.csv", small_walk(31));

  const Outcome outcome = denoise_quickly({a, b, "-o", folder / "clean.csv"});

  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("clean.csv is the name of a file; several inputs"));
  EXPECT_THAT(folder.names(), ElementsAre("a.csv", "b.csv"));
}

TEST(Batch, DryRunSaysWhatWouldBeDoneAndWritesNothing) {
  const TemporaryFolder folder;
  folder.write("in/a/walk.csv", small_walk(30));
  folder.write("in/run.npy", small_walk(30));
  const auto before = folder.names();

  const Outcome outcome =
      denoise_quickly({folder / "in", "-o", folder / "out", "--dry-run", "--keep-raw"});

  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr(folder / "in/a/walk.csv" + " -> " + folder / "out/a/walk.csv" +
                              ": median:window=7\n"),
                    HasSubstr("out/run.raw.npy: copied\n"), HasSubstr("2 takes to do")));
  EXPECT_EQ(folder.names(), before);
}

TEST(Batch, LinesHoldTheRecordAndTheOutputsOfEveryTake) {
  const TemporaryFolder folder;
  folder.write("in/walk.csv", small_walk(30));

  const Outcome outcome =
      denoise_quickly({folder / "in", "-o", folder / "out", "--lines", "-", "--mask",
                       folder / "masks", "--json", folder / "run.json"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto lines = lines_of(outcome.out);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0]["outputs"], ElementsAre(folder / "out/walk.csv", folder / "masks/walk.csv"));
  EXPECT_EQ(lines[0]["method"], "median:window=7");
  const auto record = nlohmann::json::parse(content(folder / "run.json"))["inputs"][0];
  for (const auto& [key, value] : record.items()) EXPECT_EQ(lines[0][key], value) << key;
}

TEST(Batch, TheLastLinesSayWhatWasDone) {
  const TemporaryFolder folder;
  Recording walk = small_walk(60);
  walk.samples.block(20, 3, 2, 3).array() += 500;
  walk.samples.block(40, 6, 3, 3).setConstant(std::nan(""));
  folder.write("in/walk.csv", walk);
  folder.write("in/still.csv", small_walk(60));

  const Outcome outcome =
      denoise_quickly({folder / "in", "-o", folder / "out", "--method", "hampel+interpolate"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string last = outcome.out.substr(outcome.out.find("takes    "));
  EXPECT_THAT(
      last, AllOf(StartsWith("takes    2 done, 0 failed, 0 left out (done before)\n"),
                  HasSubstr(" of 1440 corrected ("), HasSubstr(", 9 filled (0.62 %)\n"),
                  HasSubstr("largest  " + folder / "in/walk.csv" + ": "),
                  HasSubstr("of the body's size) of joint1 in frame 2"), HasSubstr("\nseconds  ")));
}

TEST(Batch, QuietLeavesWhatChangedMuchAndFailures) {
  const TemporaryFolder folder;
  Recording walk = small_walk(60);
  walk.samples.block(20, 3, 5, 3).array() += 500;
  folder.write("in/walk.csv", walk);
  folder.write_text("in/bad.csv", damaged);

  const Outcome outcome = denoise_quickly({folder / "in", "-o", folder / "out", "--quiet"});

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("walk.csv: changed much"), HasSubstr("bad.csv:3: ")));
}

// 37 takes of six formats.
void write_takes_of_all_kinds(const TemporaryFolder& folder) {
  const std::array kinds = {"csv", "npy", "trc", "c3d", "bvh", "amc"};
  for (int i = 0; i < 37; ++i) {
    const std::string kind = kinds[static_cast<std::size_t>(i) % kinds.size()],
                      stem = fmt::format("in/actor{}/take{:02}.", i % 4, i);
    if (kind == "bvh") {
      folder.write_text(stem + kind, std::string(tiny_bvh));
    } else if (kind == "amc") {
      folder.write_text(stem + kind, std::string(tiny_amc));
      folder.write_text(stem + "asf", std::string(tiny_asf));
    } else {
      folder.write(stem + kind, small_walk(20 + i, static_cast<std::uint64_t>(i + 1)));
    }
  }
}

// What is to become of the files below a folder of takes.
std::vector<std::string> expected_results(std::vector<std::string> names) {
  const bool amc = is_of_format("x.amc", can_write);  // else .csv, which needs no .asf
  std::erase_if(names, [&](const std::string& name) {
    return name.find("bad.") != name.npos || (!amc && name.ends_with(".asf"));
  });
  if (!amc)
    for (std::string& name : names)
      if (name.ends_with(".amc")) name.replace(name.size() - 3, 3, "csv");
  std::ranges::sort(names);
  return names;
}

TEST(Batch, FortyTakesOfSixFormatsOfWhichThreeAreDamaged) {
  const TemporaryFolder folder;
  write_takes_of_all_kinds(folder);
  const std::string whole = content(folder / "in/actor3/take03.c3d");
  for (const auto& [name, text] :
       {std::pair<std::string, std::string>{"in/actor0/bad.csv", damaged},
        {"in/actor1/bad.bvh", std::string(tiny_bvh.substr(0, tiny_bvh.size() - 30))},
        {"in/bad.c3d", whole.substr(0, whole.size() / 2)}})
    folder.write_text(name, text);

  const Outcome outcome = denoise_quickly({folder / "in", "-o", folder / "out"});

  EXPECT_EQ(outcome.exit_code, 1);
  std::vector<std::string> results = files_below(folder, "out");
  std::erase(results, "moclean.manifest.jsonl");
  EXPECT_EQ(results, expected_results(files_below(folder, "in")));
  std::erase_if(results, [](const std::string& name) { return name.ends_with(".asf"); });
  for (const std::string& name : results)
    EXPECT_GT(read_recording(folder / ("out/" + name)).frames(), 0) << name;
  for (const char* name : {"actor0/bad.csv:3: ", "actor1/bad.bvh", "bad.c3d: "})
    EXPECT_THAT(outcome.err, HasSubstr(name));
  EXPECT_THAT(outcome.err, EndsWith("3 of 40 takes failed, see above\n"));
}

TEST(Batch, SaysThatTheFrameRateOfAmcInBvhIsAssumed) {
  const TemporaryFolder folder;
  folder.write_text("tiny.asf", std::string(tiny_asf));
  const std::string amc = folder.write_text("tiny.amc", std::string(tiny_amc)),
                    bvh = folder / "clean.bvh";

  const Outcome assumed = denoise_quickly({amc, "-o", bvh});
  const Outcome stated = denoise_quickly({amc, "-o", bvh, "--rate", "60"});

  EXPECT_EQ(assumed.exit_code, 0) << assumed.err;
  EXPECT_THAT(assumed.err, HasSubstr("clean.bvh: no frame rate is known: BVH states 120 Hz"));
  EXPECT_THAT(stated.err, Not(HasSubstr("120 Hz")));
}

}  // namespace
}  // namespace moclean::test
