#include "moclean/core/printable.hpp"

#include <gtest/gtest.h>

namespace moclean {
namespace {

TEST(Printable, LeavesTextAsItIs) {
  EXPECT_EQ(printable("take 'Hüfte' 手 😀\nnext line \\x"), "take 'Hüfte' 手 😀\nnext line \\x");
}

TEST(Printable, EscapesWhatControlsATerminal) {
  EXPECT_EQ(printable("a\x1b[31mred\x07\r\tb\x7f"), "a\\x1B[31mred\\x07\\x0D\\x09b\\x7F");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "\\xC2\\x9B31m")
      << "CSI as a C1 control";
  EXPECT_EQ(printable("\xc2\xa0"), "\xc2\xa0") << "the first character behind them";
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
}

TEST(Printable, EscapesWhatIsNoUtf8) {
  EXPECT_EQ(printable("\xff\xfeN"), "\\xFF\\xFEN");
  EXPECT_EQ(printable("H\xfc"
                      "fte"),
            "H\\xFCfte")
      << "Latin-1";
  EXPECT_EQ(printable("\xc0\xaf"), "\\xC0\\xAF") << "overlong";
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xED\\xA0\\x80") << "a surrogate";
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xF4\\x90\\x80\\x80") << "beyond the last";
  EXPECT_EQ(printable("\xe6\x89"), "\\xE6\\x89") << "cut off";
}

}  // namespace
}  // namespace moclean
