// moclean denoise -: recordings from standard input and to standard output.

#include <filesystem>

#include <gmock/gmock.h>

#include "cli/batch_folder.hpp"

namespace moclean::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class StandardStreams : public ::testing::Test {
 protected:
  Outcome denoise(const std::string& input, std::vector<std::string> options) const {
    options.insert(options.begin(), "denoise");
    options.insert(options.end(), {"--method", "median"});
    return run(options, {.device = "", .input = input});
  }

  TemporaryFolder folder_;
  std::string walk_ = folder_.write("walk.csv", small_walk(30));
};

TEST_F(StandardStreams, GiveTheBytesOfFiles) {
  ASSERT_EQ(denoise_quickly({walk_, "-o", folder_ / "clean.csv"}).exit_code, 0);
  const std::string expected = content(folder_ / "clean.csv");

  const Outcome both = denoise(walk_, {"-", "-o", "-", "--format", "csv"});
  const Outcome only_in = denoise(walk_, {"-", "-o", folder_ / "in.csv", "--input-format", "csv"});
  const Outcome only_out = denoise("", {walk_, "-o", "-", "--format", "csv"});

  EXPECT_EQ(both.exit_code, 0) << both.err;
  EXPECT_EQ(both.out, expected);
  EXPECT_EQ(only_in.exit_code, 0) << only_in.err;
  EXPECT_EQ(content(folder_ / "in.csv"), expected);
  EXPECT_THAT(only_in.out, HasSubstr("standard input -> " + folder_ / "in.csv"));
  EXPECT_EQ(only_out.exit_code, 0) << only_out.err;
  EXPECT_EQ(only_out.out, expected);
}

TEST_F(StandardStreams, MayDifferInFormat) {
  const Outcome outcome =
      denoise(walk_, {"-", "-o", "-", "--input-format", "csv", "--format", "npy"});

  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith("\x93NUMPY"));
}

TEST_F(StandardStreams, AreCalledByTheirNamesInMessagesAndRecords) {
  const std::string bad = folder_.write_text("bad.csv", "a,b\n1,2\n3,x\n");

  const Outcome outcome = denoise(bad, {"-", "-o", "-", "--format", "csv"});
  denoise(walk_, {"-", "-o", "-", "--format", "csv", "--lines", folder_ / "l.jsonl", "--json",
                  folder_ / "r.json"});

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, StartsWith("moclean: standard input:3: expected a number"));
  EXPECT_THAT(outcome.out, IsEmpty());
  const auto line = lines_of(content(folder_ / "l.jsonl"))[0];
  EXPECT_EQ(line["file"], "standard input");
  EXPECT_EQ(line["outputs"][0], "standard output");
  EXPECT_EQ(nlohmann::json::parse(content(folder_ / "r.json"))["inputs"][0]["file"],
            "standard input");
}

TEST_F(StandardStreams, NeedAFormatAndNoCompany) {
  const std::vector<std::pair<std::vector<std::string>, const char*>> wrong = {
      {{"-", "-o", "-"}, "standard input needs --input-format FORMAT"},
      {{walk_, "-o", "-"}, "standard output needs --format FORMAT"},
      {{"-", walk_, "-o", folder_ / "out", "--format", "csv"}, "the only input"},
      {{walk_, walk_, "-o", "-", "--format", "csv"}, "the result of one input"},
      {{folder_ / "", "-o", "-", "--format", "csv"}, "the result of one input"},
      {{"-", "-o", "-", "--format", "csv", "--json", "-"}, "give --json and --lines a file"},
      {{"-", "-o", folder_ / "a.csv", "--input-format", "csv", "--keep-raw"}, "--keep-raw needs"},
      {{walk_, "-o", folder_ / "a.csv", "--input-format", "csv"}, "that of standard input"}};
  for (const auto& [options, message] : wrong) {
    const Outcome outcome = denoise(walk_, options);

    EXPECT_EQ(outcome.exit_code, 2) << message;
    EXPECT_THAT(outcome.err, HasSubstr(message));
  }
}

}  // namespace
}  // namespace moclean::test
