#include <numbers>
#include <regex>
#include <string>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/core/random.hpp"
#include "moclean/formats/amc.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/find_skeleton.hpp"
#include "moclean/formats/read_write.hpp"

#include "formats/temporary_folder.hpp"
#include "formats/tiny_files.hpp"
#include "support/data.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::largest_difference;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::string swapped(std::string_view text, const std::string& what, const std::string& with) {
  return std::regex_replace(std::string(text), std::regex(what), with);
}

Recording from_amc(std::string_view amc, std::string_view asf = test::tiny_asf) {
  return joint_positions(parse_amc(amc, "x.amc", parse_asf(asf, "x.asf")));
}

std::string as_amc(const Recording& recording) {
  const test::TemporaryFolder folder;
  write_recording(folder.path() / "x.amc", recording);
  return read_file(folder.path() / "x.amc");
}

class AmcAgain : public testing::TestWithParam<std::pair<std::string, std::string>> {};

TEST_P(AmcAgain, IsTheSameByteForByte) {
  const std::string text = swapped(test::tiny_amc, GetParam().first, GetParam().second);

  EXPECT_EQ(as_amc(from_amc(text)), text);
}

INSTANTIATE_TEST_SUITE_P(
    Each, AmcAgain,
    testing::Values(std::pair{"^$", ""}, std::pair{"\n", "\r\n"}, std::pair{"\n", "\r"},
                    std::pair{"\n", "\n\n"}, std::pair{" ", "\t"}, std::pair{"\n", " # note\n"},
                    std::pair{"^", "\xEF\xBB\xBF"}, std::pair{":DEGREES", ":RADIANS"},
                    std::pair{":DEGREES\n", ""}, std::pair{"0 90\n", "-0.0 +9.0e1\n"},
                    std::pair{"\n$", ""}, std::pair{"$", "\n# end\n"}));

TEST(AmcWrite, TurnsPositionsIntoRotationsAndKeepsTheTextOfAllElse) {
  Recording take = from_amc(test::tiny_amc);
  // Frame 1: the thigh's turn about its x, which is the world's y, moves nothing that points down;
  // about z by 90 degrees its joint goes from below to x, as in frame 2.
  take.samples.row(0) = take.samples.row(1);

  const std::string text = as_amc(take);
  const Recording back = from_amc(text);

  EXPECT_LE(largest_difference(back.samples, take.samples), 1e-4);
  EXPECT_THAT(text, testing::StartsWith("#!OML:ASF tiny.asf\n:FULLY-SPECIFIED\n:DEGREES\n1\n"));
  EXPECT_EQ(text.substr(text.find("\n2\n")), test::tiny_amc.substr(test::tiny_amc.find("\n2\n")));
}

TEST(AmcWrite, WritesRadiansWhereTheFileHasThem) {
  const std::string text = ":FULLY-SPECIFIED\n:RADIANS\n1\nroot 1 2 3 0 0 0\nthigh 0 0.5\n";
  Recording take = from_amc(text);
  Matrix channels = take.channels;
  channels(0, 6) = 0.25;  // thigh's z
  take.samples = forward_kinematics(*take.skeleton, channels);

  EXPECT_EQ(as_amc(take), swapped(text, "0 0.5\n", "0 0.2500\n"));
}

TEST(AmcWrite, TurnsBonesWithinTheirDegreesOfFreedomAlone) {
  Recording take = from_amc(test::tiny_amc);
  const Matrix reachable = take.samples;
  for (double& value : take.samples.reshaped()) value += 0.1 * std::sin(value);

  const Recording back = from_amc(as_amc(take));

  ASSERT_EQ(back.channels.cols(), take.channels.cols());
  EXPECT_LE((back.samples - take.samples).norm(), (reachable - take.samples).norm());
  // The shin has no degree of freedom: it stays in line with the thigh.
  for (Index f = 0; f < 3; ++f) {
    const auto joint = [&](Index j) { return back.samples.row(f).segment<3>(3 * j); };
    EXPECT_LE(((joint(2) - joint(1)) / 3 - (joint(1) - joint(0)) / 2).norm(), 1e-9);
  }
}

TEST(AmcWrite, WritesTheFramesThereAreUnderTheirNumbers) {
  const std::string text = swapped(test::tiny_amc, "# .*", "");
  const std::size_t second = text.find("2\nthigh"), third = text.find("3\nroot");
  const Recording take = from_amc(text);

  EXPECT_EQ(as_amc(excerpt(take, 1, 3)),
            text.substr(0, text.find("1\nroot")) + text.substr(second));
  EXPECT_EQ(as_amc(excerpt(take, 0, 2)), text.substr(0, third));
}

TEST(AmcWrite, KeepsANumberThatIsMissing) {
  const std::string text = swapped(test::tiny_amc, "0 90\n", "0 nan\n");
  Recording take = from_amc(text);

  EXPECT_TRUE(take.samples.row(1).tail(6).array().isNaN().all());
  EXPECT_TRUE(take.samples.row(1).head(3).allFinite());
  EXPECT_EQ(as_amc(take), text);

  take.samples.row(1) = from_amc(test::tiny_amc).samples.row(1);
  const Recording filled = from_amc(as_amc(take));

  EXPECT_LE(largest_difference(filled.samples, take.samples), 1e-4);
}

// A number sign is a comment elsewhere.
TEST(AmcWrite, KeepsWhatMicrosoftsRuntimesPrintForNone) {
  const std::string text = swapped(test::tiny_amc, "0 90\n", "-1.#IND00 1.#QNAN # none\n");
  const Recording take = from_amc(text);

  EXPECT_TRUE(take.channels.row(1).tail(2).array().isNaN().all());
  EXPECT_EQ(as_amc(take), text);
}

// A comma behind one made decimal commas of all changed numbers, which no reader of AMC takes.
TEST(AmcRead, RefusesWhatOnlyBeginsLikeThem) {
  EXPECT_THAT([] { from_amc(swapped(test::tiny_amc, "0 90\n", "1.#QNAN, 90\n")); },
              ThrowsMessage<FileError>(HasSubstr("expected a number, found '1.#QNAN,'")));
}

TEST(AmcWrite, RefusesRotationsOfOtherSkeletons) {
  Recording take = from_amc(test::tiny_amc);
  take.source.reset();

  EXPECT_THAT([&] { as_amc(take); },
              ThrowsMessage<FileError>(HasSubstr("rotations of others go into .bvh")));
}

class AmcOfTake : public testing::TestWithParam<const char*> {};

TEST_P(AmcOfTake, ComesBackByteForByte) {
  const auto file = test::shared_data(GetParam());
  MOCLEAN_REQUIRE_FILE(file);

  EXPECT_TRUE(as_amc(read_recording(file)) == read_file(file));
}

TEST_P(AmcOfTake, FindsExactPositionsFromOtherRotations) {
  const auto file = test::shared_data(GetParam());
  MOCLEAN_REQUIRE_FILE(file);
  Recording take = read_recording(file, {.skeleton = {}, .frames = {.first = 0, .last = 100}});
  Random random(3);
  for (double& value : take.channels.reshaped()) value += 0.1 * random.normal();

  const AcclaimSkeleton skeleton = read_asf(find_skeleton(file));
  const Recording back = joint_positions(parse_amc(as_amc(take), "x.amc", skeleton));

  const double size = 25;  // ASF units, about that of a man
  EXPECT_LE(largest_difference(back.samples, take.samples), 1e-4 * size);
}

INSTANTIATE_TEST_SUITE_P(Real, AmcOfTake,
                         testing::Values("cmu/02/02_01.amc", "cmu/09/09_06.amc", "cmu/49/49_18.amc",
                                         "hdm05/HDM_bk_kickLFront1Reps_007_120.amc",
                                         "hdm05/HDM_dg_lieDownFloor_014_120.amc"));

}  // namespace
}  // namespace moclean
