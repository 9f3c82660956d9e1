#include "moclean/experiment/grid_config.hpp"

#include <array>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/read_write.hpp"

#include "experiment/grid_text.hpp"
#include "formats/temporary_folder.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class GridFile : public ::testing::Test {
 protected:
  GridConfig read(const std::string& text, const Environment& environment = {}) const {
    return read_grid(folder_.file("grid.toml", text), {}, environment);
  }

  // The message, from the line number on.
  void expect_refused(const std::string& text, const std::string& message) const {
    EXPECT_THAT([&] { read(text); }, ThrowsMessage<FileError>(HasSubstr("grid.toml:" + message)))
        << text;
  }

  // `grid_text` with one part replaced.
  static std::string with(const std::string& part, const std::string& other) {
    std::string text = grid_text;
    return text.replace(text.find(part), part.size(), other);
  }

  TemporaryFolder folder_;
};

TEST_F(GridFile, IsReadWithEveryKey) {
  const GridConfig config = read(grid_text);

  EXPECT_THAT(config.seeds, ElementsAre(3, 1));
  ASSERT_EQ(config.takes.size(), 2U);
  EXPECT_EQ(config.takes[0].file, folder_.path() / "walk.npy");
  EXPECT_EQ(config.takes[0].label, "walk");
  EXPECT_EQ(config.takes[0].frames, (FrameSpan{2, 8}));
  EXPECT_EQ(config.takes[0].rate, 60);
  EXPECT_THAT(config.takes[0].excluded, ElementsAre("hand", "Toe"));
  EXPECT_EQ(config.takes[1].file, folder_.path() / "nowhere/run.npy");
  EXPECT_TRUE(config.takes[1].optional);
  EXPECT_THAT(config.takes[1].excluded, ElementsAre("hand"));
  EXPECT_EQ(config.noises.at(0).label, "both");
  EXPECT_EQ(config.noises.at(0).noise,
            (NoiseChain{Gap{{.count = 1, .length = 3}}, GaussianFrames{.fraction = 0.5}}));
  EXPECT_EQ(config.methods.at(0).label, "none");
  EXPECT_TRUE(config.methods.at(0).chain.empty());
  EXPECT_EQ(to_string(config.methods.at(1).chain),
            to_string(parse_chain("hampel:window=5+slra:rho=1.7")));
}

TEST_F(GridFile, SeedsMayBeACount) {
  EXPECT_THAT(read(with("[3, 1]", "3")).seeds, ElementsAre(1, 2, 3));
}

TEST_F(GridFile, PathsMayNameTheEnvironment) {
  const Environment environment = [](const char* name) {
    return std::string(name) == "PLACE" ? "/data" : nullptr;
  };

  EXPECT_EQ(read(grid_text, environment).takes[1].file, "/data/run.npy");
  expect_refused(with("${PLACE:-nowhere}", "${MOCLEAN_NOT_SET}"),
                 "11: take 2: file: the environment variable MOCLEAN_NOT_SET is not set");
  expect_refused(with("${PLACE:-nowhere}", "${PLACE"), "11: take 2: file: expected } after ${");
}

// What ends a program that uses toml++ with assertions, and is assumed not to be without.
TEST_F(GridFile, WhatTomlAssertsIsAnErrorWithItsLine) {
  expect_refused("seeds = 2\n\n[\x1f]\x1f", "3: expected TOML");
}

TEST_F(GridFile, SeedsAreBounded) {
  expect_refused(with("[3, 1]", "9223372036854775807"),
                 "1: seeds: expected how many (1 to 1000000)");
}

TEST_F(GridFile, ErrorsNameLineKeyAndWhatWasExpected) {
  expect_refused("seeds = ", "1: ");
  expect_refused("", "1: seeds: missing, expected how many (1 to 1000000) or a list");
  expect_refused(with("[3, 1]", "0"), "1: seeds: expected how many (1 to 1000000)");
  expect_refused(with("[3, 1]", "[1, -1]"), "1: seeds: expected how many (1 to 1000000)");
  expect_refused(with("[3, 1]", "\"two\""), "1: seeds: expected how many");
  expect_refused(with("seeds", "sedes"),
                 "1: sedes: unknown key, expected one of seeds, columns_exclude, take");
  expect_refused(with("file = \"walk.npy\"", ""), "4: take 1: file: missing, expected a text");
  expect_refused(with("\"walk.npy\"", "7"), "5: take 1: file: expected a text, found 7");
  expect_refused(with("2:8", "8:2"), "6: take 1: frames: expected \"A:B\" with A < B");
  expect_refused(with("rate = 60", "rate = -1"),
                 "7: take 1: rate: expected a number from 1e-06 to 1000000");
  expect_refused(with("[\"Toe\"]", "\"Toe\""), "8: take 1: columns_exclude: expected a list");
  expect_refused(with("= true", "= 1"), "13: take 2: optional: expected true or false, found 1");
  expect_refused(with("optional", "options"), "13: take 2: options: unknown key, expected one of");
  expect_refused(with("gap:count=1", "gap:cont=1"), "16: noise 1: spec: noise gap: unknown key");
  expect_refused(with("hampel:window=5", "hample"), "23: method 2: spec: unknown method 'hample'");
  expect_refused(with("\"chain\"", "\"none\""), "24: method 2: label: 'none' is that of number 1");
  expect_refused("seeds = 1\ntake = 3\n", "2: take: expected tables, [[take]]");
  expect_refused("seeds = 1\n[[take]]\nfile = \"a.csv\"\n",
                 "1: noise: missing, expected at least one [[noise]]");
}

TEST_F(GridFile, LettersBeyondAsciiStandInQuotesAndComments) {
  expect_refused("seeds = 2\n# é\ngröße = 1\n",
                 "3: expected letters of ASCII outside of quotes, found 'öße'");
  constexpr std::array quoted_ways = {"\"\\\"é\" # é", "'é\"'", "\"\"\"\né\" \"\"\"\"\"",
                                      "'''é'\n'''''"};
  for (const char* quoted : quoted_ways)
    EXPECT_NE(read(with("\"both\"", quoted)).noises.at(0).label.find("é"), std::string::npos)
        << quoted;
}

TEST_F(GridFile, TakesAreReadAndCut) {
  write_recording(folder_.path() / "walk.npy", synthetic_walk(20));
  const GridConfig config = read(grid_text);

  const GridTakes found = read_takes(config);

  ASSERT_EQ(found.takes.size(), 1U);
  EXPECT_EQ(found.takes[0].clip.samples, synthetic_walk(20).samples.middleRows(2, 6));
  EXPECT_EQ(found.takes[0].clip.frame_rate, 60);
  EXPECT_THAT(found.missing, ElementsAre(folder_.path() / "nowhere/run.npy"));
}

TEST_F(GridFile, TakesAreThinnedAfterTheyAreCut) {
  write_recording(folder_.path() / "walk.npy", synthetic_walk(20));

  const GridConfig config = read(with("rate = 60", "rate = 60\nthin = 4"));
  const Recording thinned = read_takes(config).takes.at(0).clip;

  const Matrix walk = synthetic_walk(20).samples;
  EXPECT_EQ(config.takes[0].thin, 4);
  EXPECT_EQ(config.takes[1].thin, 1);
  ASSERT_EQ(thinned.frames(), 2);  // frames 2 and 6 of 2 .. 7
  EXPECT_EQ(thinned.samples.row(0), walk.row(2));
  EXPECT_EQ(thinned.samples.row(1), walk.row(6));
  EXPECT_EQ(thinned.frame_rate, 15);
  EXPECT_EQ(thinned.columns.size(), 93U);
  for (const char* wrong : {"0", "1.5", "\"2\""})
    expect_refused(with("rate = 60", std::string("thin = ") + wrong),
                   "7: take 1: thin: expected a whole number of 1 to 1000000");
}

TEST_F(GridFile, TakesThatCannotServeAreRefused) {
  Recording walk = synthetic_walk(20);
  walk.samples(3, 5) = std::nan("");
  write_recording(folder_.path() / "walk.npy", walk);

  EXPECT_THAT([&] { read_takes(read(grid_text)); },
              ThrowsMessage<FileError>(HasSubstr("walk.npy: frame 3, column joint1.z is nan")));
  EXPECT_THAT([&] { read_takes(read(with("2:8", "2:21"))); },
              ThrowsMessage<FileError>(HasSubstr("grid.toml:4: frames 2:21 do not fit")));
  EXPECT_THAT([&] { read_takes(read(with("walk.npy", "talk.npy"))); },
              ThrowsMessage<FileError>(HasSubstr("talk.npy: there is no such file")));
  EXPECT_THAT([&] { read_takes(read(with("rate = 60", "optional = true"))).takes.clear(); },
              ThrowsMessage<FileError>(HasSubstr("walk.npy: frame 3")));
}

}  // namespace
}  // namespace moclean::test
