// Every command but denoise and evaluate: help, version, usage, corrupt, convert, info, devices.

#include <gmock/gmock.h>

#include "moclean/formats/formats.hpp"
#include "moclean/formats/read_write.hpp"
#include "moclean/metric/metric.hpp"

#include "cli/program.hpp"
#include "support/data.hpp"
#include "support/matrix.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean::test {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(Commands, HelpOfEveryCommandEndsWithAnExample) {
  for (const std::string command :
       {"denoise", "corrupt", "evaluate", "convert", "info", "devices"}) {
    const Outcome help = run({command, "--help"});

    EXPECT_EQ(help.exit_code, 0) << command;
    const std::size_t example = help.out.rfind("Example:\n");
    ASSERT_NE(example, std::string::npos) << command;
    EXPECT_THAT(help.out.substr(example), HasSubstr("moclean " + command));
  }
}

TEST(Commands, HelpNamesEveryFormat) {
  const std::string read = "(" + listed_extensions(can_read) + ")";
  const std::string written = "(" + listed_extensions(can_write) + ")";
  for (const std::string command : {"denoise", "corrupt", "convert", "info"})
    EXPECT_THAT(run({command, "--help"}).out, HasSubstr(read)) << command;
  for (const std::string command : {"denoise", "corrupt", "convert"})
    EXPECT_THAT(run({command, "--help"}).out, HasSubstr(written)) << command;
  EXPECT_THAT(run({"experiment", "table2", "--help"}).out, HasSubstr(read));
  EXPECT_THAT(run({"evaluate", "--help"}).out, HasSubstr(any_extension(has_skeleton)));

  const std::string formats_help = run({"convert", "--help"}).out;
  for (const Format* format : formats())
    EXPECT_THAT(formats_help, HasSubstr("\n  " + std::string(format->extension) + " "));
}

TEST(Commands, PrintsItsVersion) {
  const Outcome version = run({"--version"});

  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.out, "moclean " MOCLEAN_VERSION "\n");
}

TEST(Commands, UsageErrorsExitWith2AndPointToHelp) {
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"clean"},
      {"info"},
      {"info", "walk.csv", "--colour"},
      {"convert", "walk.csv"},
      {"corrupt", "walk.csv", "-o", "noisy.csv"},
      {"evaluate", "walk.csv"},
  };
  for (const auto& arguments : wrong) {
    const Outcome outcome = run(arguments);

    EXPECT_EQ(outcome.exit_code, 2) << ::testing::PrintToString(arguments);
    EXPECT_THAT(outcome.out, IsEmpty());
    EXPECT_THAT(outcome.err, ::testing::StartsWith("moclean: "));
    EXPECT_THAT(outcome.err, HasSubstr("--help)"));
  }
}

TEST(Commands, MistypedNamesGetTheNearest) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{"denose", "a.bvh"}, "unknown command denose; did you mean 'denoise'?"},
      {{"info", "a.bvh", "--jsno"}, "unknown option --jsno; did you mean '--json'?"},
      {{"experiment", "tabel2"}, "unknown command tabel2; did you mean 'table2'?"},
      {{"experiment", "grid", "a.toml", "--seed=3"}, "did you mean '--seeds'?"},
      {{"corrupt", "a.bvh", "--nose", "x"}, "unknown option --nose; did you mean '--noise'?"}};
  for (const auto& [arguments, message] : wrong) {
    const Outcome outcome = run(arguments);

    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(message));
  }
  EXPECT_THAT(run({"info", "a.bvh", "--colour"}).err, Not(HasSubstr("did you mean")));
}

TEST(Corrupt, SameSeedGivesTheSameFile) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("walk.npy", synthetic_walk(60));
  const auto noisy = [&](const std::string& name, const std::string& seed) {
    return run({"corrupt", walk, "-o", folder / name, "--noise", "gaussian-frames:frames=20",
                "--seed", seed});
  };

  const Outcome first = noisy("a.npy", "1");
  noisy("b.npy", "1");
  noisy("c.npy", "2");

  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_TRUE(content(folder / "a.npy") == content(folder / "b.npy"));
  EXPECT_TRUE(content(folder / "a.npy") != content(folder / "c.npy"));
}

TEST(Corrupt, SaysHowManyEntriesChanged) {
  const TemporaryFolder folder;
  const Recording clean = synthetic_walk(60);
  const std::string walk = folder.write("walk.npy", clean);

  const Outcome outcome = run({"corrupt", walk, "-o", folder / "noisy.npy", "--noise",
                               "gaussian-frames:frames=20", "--seed", "1"});

  const Comparison comparison = compare(clean, read_recording(folder / "noisy.npy"));
  EXPECT_THAT(outcome.out, HasSubstr(std::to_string(comparison.changed) + " of 5580 entries"));
}

TEST(Corrupt, WritesTheMaskOfWhatItTouched) {
  const TemporaryFolder folder;
  const Recording clean = synthetic_walk(60);
  const std::string walk = folder.write("walk.npy", clean);

  const Outcome outcome =
      run({"corrupt", walk, "-o", folder / "noisy.npy", "--mask", folder / "mask.csv", "--noise",
           "gap:count=2,length=9", "--seed", "3"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Recording mask = read_recording(folder / "mask.csv"),
                  noisy = read_recording(folder / "noisy.npy");
  EXPECT_EQ(mask.columns, clean.columns);
  EXPECT_TRUE(((mask.samples.array() == 1) == noisy.samples.array().isNaN()).all());
  EXPECT_TRUE((mask.samples.array() == 0 || mask.samples.array() == 1).all());
  EXPECT_GT(mask.samples.sum(), 0);
}

TEST(Corrupt, RefusesToWriteTheMaskOverTheClip) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("walk.npy", synthetic_walk(9));

  const Outcome outcome = run({"corrupt", walk, "-o", folder / "a.csv", "--mask", folder / "a.csv",
                               "--noise", "gaussian:sd=1"});

  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("-o and --mask would both write"));
}

TEST(Corrupt, WrongNoiseIsAUsageError) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("walk.npy", synthetic_walk(60));

  const Outcome unknown = run({"corrupt", walk, "-o", folder / "a.csv", "--noise", "pink"});
  const Outcome too_many =
      run({"corrupt", walk, "-o", folder / "a.csv", "--noise", "gaussian-frames:frames=61"});

  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("unknown noise 'pink'"));
  EXPECT_EQ(too_many.exit_code, 2);
  EXPECT_THAT(too_many.err, HasSubstr("has only 60 frames"));
  EXPECT_THAT(folder.names(), ElementsAre("walk.npy"));
}

TEST(Convert, CsvToNpyAndBackKeepsEverySample) {
  const TemporaryFolder folder;
  Recording clip = synthetic_walk(20);
  clip.samples(3, 4) = std::nan("");
  const std::string walk = folder.write("walk.csv", clip);

  ASSERT_EQ(run({"convert", walk, folder / "walk.npy"}).exit_code, 0);
  ASSERT_EQ(run({"convert", folder / "walk.npy", folder / "back.csv", "--rate", "120"}).exit_code,
            0);

  const Recording back = read_recording(folder / "back.csv");
  EXPECT_EQ(back.frame_rate, 120);
  EXPECT_EQ(back.samples.array().isNaN().count(), 1);
  EXPECT_TRUE(std::isnan(back.samples(3, 4)));
  clip.samples(3, 4) = 0;
  Matrix filled = back.samples;
  filled(3, 4) = 0;
  EXPECT_TRUE(same_bits(filled, clip.samples));
}

TEST(Convert, ReplacesItsInputOnlyWhereItIsTold) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("walk.csv", synthetic_walk(20));
  std::filesystem::create_symlink(walk, folder / "link.csv");
  std::filesystem::create_hard_link(walk, folder / "hard.csv");
  const std::string before = content(walk);

  for (const char* name : {"walk.csv", "link.csv", "hard.csv"}) {
    const std::string output = folder / name;
    for (const auto& outcome : {run({"convert", walk, output, "--frames", "0:5"}),
                                run({"corrupt", walk, "-o", output, "--noise", "gaussian:sd=1"}),
                                run({"corrupt", walk, "-o", folder / "noisy.csv", "--mask", output,
                                     "--noise", "gaussian:sd=1"})}) {
      EXPECT_EQ(outcome.exit_code, 2) << name;
      EXPECT_THAT(outcome.err, HasSubstr("is an input; --force replaces it")) << name;
    }
  }
  EXPECT_EQ(content(walk), before);
  ASSERT_EQ(run({"convert", walk, walk, "--frames", "0:5", "--force"}).exit_code, 0);
  EXPECT_EQ(read_recording(walk).frames(), 5);
}

TEST(Convert, SaysWhatIsLostAndFailsIfThatIsNotAllowed) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("walk.csv", synthetic_walk(20));

  const Outcome strict = run({"convert", walk, folder / "walk.npy", "--strict"});
  const Outcome outcome = run({"convert", walk, folder / "walk.npy"});

  EXPECT_EQ(strict.exit_code, 1);
  EXPECT_THAT(strict.err,
              HasSubstr("walk.npy: cannot be written: NPY does not hold the frame rate (120 Hz)"));
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("walk.npy: NPY does not hold the frame rate (120 Hz)\n"));
  EXPECT_THAT(folder.names(), ElementsAre("walk.csv", "walk.npy"));
}

TEST(Convert, TurnsASkeletonIntoJointPositions) {
  const auto take = debian_take("01_01.bvh");
  MOCLEAN_REQUIRE_FILE(take);
  const TemporaryFolder folder;

  const Outcome outcome = run({"convert", take.string(), folder / "take.npy", "--frames", "10:30"});

  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const Recording expected = excerpt(read_recording(take), 10, 30);
  EXPECT_TRUE(same_bits(read_recording(folder / "take.npy").samples, expected.samples));
}

TEST(Convert, ReportsAMalformedFileWithItsLine) {
  const TemporaryFolder folder;
  const std::string file = folder.write_text("bad.csv", "a,b\n1,2\n3,x\n");

  const Outcome outcome = run({"convert", file, folder / "out.npy"});

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, ::testing::StartsWith("moclean: " + file + ":3: "));
  EXPECT_THAT(folder.names(), ElementsAre("bad.csv"));
}

TEST(Convert, WritesRotationsOnlyOverTheirSkeleton) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("walk.csv", synthetic_walk(4));

  const Outcome outcome = run({"convert", walk, folder / "walk.bvh"});

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("BVH holds rotations of a skeleton"));
}

TEST(Info, StatesWhatTheFileHolds) {
  const TemporaryFolder folder;
  Recording clip = synthetic_walk(60);
  clip.samples(1, 2) = std::nan("");
  const std::string walk = folder.write("walk.csv", clip);

  const Outcome text = run({"info", walk});
  const nlohmann::json record = run({"info", walk, "--json"}).json();

  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("joint30"));
  EXPECT_EQ(record["format"], "csv");
  EXPECT_EQ(record["frames"], 60);
  EXPECT_EQ(record["columns"], 93);
  EXPECT_EQ(record["joints"].size(), 31);
  EXPECT_EQ(record["rate"], 120);
  EXPECT_EQ(record["unit"], nullptr);
  EXPECT_EQ(record["duration"], 0.5);
  EXPECT_EQ(record["missing"], 1);
}

TEST(Info, UnknownRateIsNull) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("walk.npy", synthetic_walk(60));

  const nlohmann::json record = run({"info", walk, "--json"}).json();

  EXPECT_EQ(record["rate"], nullptr);
  EXPECT_EQ(record["duration"], nullptr);
}

TEST(Info, MissingFileFails) {
  const Outcome outcome = run({"info", "no-such-take.bvh"});

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("no-such-take.bvh"));
}

TEST(Devices, ListsEveryDevice) {
  const nlohmann::json records = run({"devices", "--json"}).json();
  if (records.empty()) GTEST_SKIP() << "no OpenCL device";

  const Outcome text = run({"devices"});

  for (const nlohmann::json& record : records) {
    EXPECT_THAT(text.out, HasSubstr(record["name"].get<std::string>()));
    for (const char* field : {"platform", "index", "platform_name", "driver", "version", "kind",
                              "fp64", "compute_units", "vector_width", "global_memory",
                              "max_allocation", "local_memory", "max_work_group"})
      EXPECT_TRUE(record.contains(field)) << field;
  }
}

}  // namespace
}  // namespace moclean::test
