#include "moclean/formats/losses.hpp"

#include <gmock/gmock.h>

#include "moclean/formats/bvh.hpp"
#include "moclean/formats/c3d.hpp"
#include "moclean/formats/csv.hpp"
#include "moclean/formats/npy.hpp"
#include "moclean/formats/trc.hpp"

#include "support/nan.hpp"

namespace moclean {
namespace {

using test::nan;
using testing::ElementsAre;
using testing::IsEmpty;

Recording hip(double z) { return {Matrix{{1, 2, z}}, {"hip.x", "hip.y", "hip.z"}, 120, "mm"}; }

TEST(Losses, NameWhatTheTargetCannotHold) {
  Recording take = hip(nan);
  take.up = UpAxis::z;
  take.notes.passed_through = {"Frame", "Time"};

  EXPECT_THAT(
      losses(take, csv_format, npy_format),
      ElementsAre("NPY does not hold names of joints or columns",
                  "NPY does not hold the frame rate (120 Hz)",
                  "NPY does not hold the unit of length (mm)", "NPY does not hold the upward axis",
                  "NPY does not hold columns that are no samples (2)"));
}

TEST(Losses, AreNoneWithinAFormatAndOfWhatIsHeld) {
  EXPECT_THAT(losses(hip(3), c3d_format, c3d_format), IsEmpty());
  EXPECT_THAT(losses(hip(3), trc_format, csv_format), IsEmpty());
}

TEST(Losses, AreOfRotationsOfAnalogSamplesAndOfDigits) {
  Recording take = hip(3);
  EXPECT_THAT(losses(take, c3d_format, csv_format),
              ElementsAre("CSV does not hold analog samples, events and parameters of C3D"));
  EXPECT_THAT(losses(take, csv_format, c3d_format),
              ElementsAre("C3D does not hold more than single precision"));
  take.channels = Matrix{{0, 0, 0}};
  EXPECT_THAT(losses(take, bvh_format, csv_format),
              ElementsAre("CSV does not hold rotations and bones, only positions"));
}

TEST(Losses, SayThatARateIsMadeUp) {
  Recording take = hip(3);
  take.unit.clear();
  take.frame_rate = 0;
  EXPECT_THAT(losses(take, csv_format, bvh_format),
              ElementsAre("no frame rate is known: BVH states 120 Hz; --rate states another"));
}

}  // namespace
}  // namespace moclean
