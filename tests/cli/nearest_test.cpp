#include "cli/nearest.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace moclean::cli {
namespace {

TEST(EditDistance, CountsLettersPutInLeftOutReplacedAndExchanged) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("slra", ""), 4u);
  EXPECT_EQ(edit_distance("", "slra"), 4u);
  EXPECT_EQ(edit_distance("slra", "slra"), 0u);
  EXPECT_EQ(edit_distance("slr", "slra"), 1u);
  EXPECT_EQ(edit_distance("slrra", "slra"), 1u);
  EXPECT_EQ(edit_distance("sira", "slra"), 1u);
  EXPECT_EQ(edit_distance("lsra", "slra"), 1u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("ca", "abc"), 3u);  // 2 if a letter might be moved twice
  EXPECT_EQ(edit_distance("AUTO", "auto"), 0u);
}

TEST(DidYouMean, NamesTheNearestOfThoseThatAreNear) {
  const std::vector<std::string> names = {"denoise", "devices", "tune"};

  EXPECT_EQ(did_you_mean("denose", names), "; did you mean 'denoise'?");
  EXPECT_EQ(did_you_mean("device", names), "; did you mean 'devices'?");
  EXPECT_EQ(did_you_mean("tnue", names), "; did you mean 'tune'?");
  EXPECT_EQ(did_you_mean("clean", names), "");
  EXPECT_EQ(did_you_mean(std::string(1 << 20, 'a'), names), "");
  EXPECT_EQ(did_you_mean("x", {}), "");
}

}  // namespace
}  // namespace moclean::cli
