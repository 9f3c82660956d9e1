// moclean on files of rotations.

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "moclean/formats/file.hpp"
#include "moclean/formats/read_write.hpp"

#include "cli/program.hpp"
#include "support/matrix.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean::test {
namespace {

using ::testing::HasSubstr;

constexpr int spike_frame = 30;

// An arm that swings; its elbow's Zrotation is off by some degrees in one frame.
std::string swinging_arm(double spike) {
  std::string text = R"(HIERARCHY
ROOT shoulder { OFFSET 0 0 0 CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT elbow { OFFSET 30 0 0 CHANNELS 3 Zrotation Xrotation Yrotation
    JOINT hand { OFFSET 25 0 0 CHANNELS 3 Zrotation Xrotation Yrotation
      End Site { OFFSET 8 0 0 } } } }
MOTION
Frames: 60
Frame Time: 0.008333
)";
  for (int f = 0; f < 60; ++f) {
    const double wave = 40 * std::sin(0.05 * f);
    text += fmt::format("0 {:.4f} 0 {:.4f} 5.0 0.0 {:.4f} 0 0 0 0 0\n", 90 + 0.05 * wave, wave,
                        20 + 0.7 * wave + (f == spike_frame ? spike : 0));
  }
  return text;
}

TEST(Rotations, ComeBackByteForByteWithoutAMethod) {
  const TemporaryFolder folder;
  const std::string file = folder.write_text("arm.bvh", swinging_arm(25));

  const Outcome outcome = run({"denoise", file, "-o", folder / "same.bvh", "--method", "none"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(read_file(folder / "same.bvh"), read_file(file));
}

TEST(Rotations, AreCleanedWhereTheirDamageIs) {
  const TemporaryFolder folder;
  const std::string file = folder.write_text("arm.bvh", swinging_arm(25));

  const Outcome outcome = run(
      {"denoise", file, "-o", folder / "clean.bvh", "--from-rotations", "--method", "interpolate"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("1 spikes were taken out of the channels of the skeleton, the "
                                     "largest turn 25 degrees of elbow in frame 30"));
  const Recording clean = read_recording(folder / "clean.bvh");
  const std::string truth = folder.write_text("truth.bvh", swinging_arm(0));
  EXPECT_LE(largest_difference(clean.samples, read_recording(truth).samples), 0.05);
  // All lines but that of the spike are those of the input.
  const std::string before = read_file(file), after = read_file(folder / "clean.bvh");
  const auto head = static_cast<std::size_t>(
      std::mismatch(before.begin(), before.end(), after.begin()).first - before.begin());
  EXPECT_EQ(std::count(before.begin(), before.begin() + static_cast<long>(head), '\n'),
            9 + spike_frame - 1);
  EXPECT_EQ(before.substr(before.find('\n', head)), after.substr(after.find('\n', head)));
}

TEST(Rotations, AreNotInFilesOfPositions) {
  const TemporaryFolder folder;
  const std::string walk = folder.write("walk.csv", synthetic_walk(30));

  const Outcome outcome = run(
      {"denoise", walk, "-o", folder / "clean.csv", "--from-rotations", "--method", "interpolate"});

  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("has no rotations of a skeleton, expected .bvh or .amc"));
}

TEST(Rotations, OfAnAcclaimTakeGoIntoABvh) {
  const TemporaryFolder folder;
  folder.write_text("leg.asf", R"(:root
 order TX TY TZ RX RY RZ
 position 0 0 0
 orientation 0 0 0
:bonedata
 begin
  name thigh
  direction 0 -1 0
  length 4
  axis 0 0 30 XYZ
  dof rx rz
 end
:hierarchy
 begin
  root thigh
 end
)");
  const std::string amc = folder.write_text(
      "leg.amc",
      ":DEGREES\n1\nroot 1 2 3 10 20 30\nthigh 40 50\n2\nroot 1 2 3 11 20 30\nthigh 42 49\n");

  const Outcome outcome =
      run({"denoise", amc, "-o", folder / "leg.bvh", "--method", "interpolate", "--rate", "50"});

  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Recording take = read_recording(amc), back = read_recording(folder / "leg.bvh");
  EXPECT_EQ(back.frame_rate, 50);
  EXPECT_LE(largest_difference(back.samples.rightCols(3), take.samples.rightCols(3)), 1e-6);
}

TEST(Rotations, OfABvhDoNotGoIntoAnAmc) {
  const TemporaryFolder folder;
  const std::string file = folder.write_text("arm.bvh", swinging_arm(0));

  const Outcome outcome =
      run({"denoise", file, "-o", folder / "arm.amc", "--method", "interpolate"});

  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("without rotations of its own skeleton, expected .bvh"));
}

}  // namespace
}  // namespace moclean::test
