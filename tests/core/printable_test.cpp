#include "moclean/core/printable.hpp"

#include <gtest/gtest.h>

namespace moclean {
namespace {

TEST(Printable, LeavesTextAsItIs) {
  const std::string text = "take 'Hüfte' 手 😀\nnext line \\x";
  EXPECT_EQ(printable(text), text);
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

TEST(Printable, EscapesWhatTurnsOrHidesText) {
  EXPECT_EQ(printable("walk\u202Evsc.exe"), "walk\\xE2\\x80\\xAEvsc.exe") << "right to left";
  EXPECT_EQ(printable("a\u2066b\u2069"), "a\\xE2\\x81\\xA6b\\xE2\\x81\\xA9") << "isolates";
  EXPECT_EQ(printable("a\u200Fb\u061C"), "a\\xE2\\x80\\x8Fb\\xD8\\x9C") << "marks";
  EXPECT_EQ(printable("a\u2028b"), "a\\xE2\\x80\\xA8b") << "a line separator";
  EXPECT_EQ(printable("\uFEFFx"), "\\xEF\\xBB\\xBFx") << "a byte order mark";
  EXPECT_EQ(printable("\U000E0041"), "\\xF3\\xA0\\x81\\x81") << "a tag";
  EXPECT_EQ(printable("می\u200Cخواهم"), "می\u200Cخواهم") << "a joiner is spelling";
}

TEST(PrintableLine, HasNoLineFeed) {
  EXPECT_EQ(printable_line("a\nb\u2029\x1b"), "a\\x0Ab\\xE2\\x80\\xA9\\x1B");
}

}  // namespace
}  // namespace moclean
