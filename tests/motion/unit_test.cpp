#include "moclean/motion/unit.hpp"

#include <gtest/gtest.h>

#include "support/tolerance.hpp"

namespace moclean {
namespace {

TEST(Millimetres, KnowTheUnitsThatFilesState) {
  EXPECT_EQ(millimetres("mm"), 1);
  EXPECT_EQ(millimetres("cm"), 10);
  EXPECT_EQ(millimetres("m"), 1000);
  EXPECT_NEAR(millimetres("ASF units").value(), 508 / 9.0, test::tolerance::by_hand(56));
}

TEST(Millimetres, GuessNothing) {
  EXPECT_FALSE(millimetres(""));
  EXPECT_FALSE(millimetres("inch"));
  EXPECT_FALSE(millimetres("MM"));
}

}  // namespace
}  // namespace moclean
