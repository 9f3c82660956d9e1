#include "moclean/formats/text_scanner.hpp"

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

using testing::StrEq;
using testing::ThrowsMessage;

TextScanner scan(std::string_view text) {
  return TextScanner(text, "x", {.marks = "{}", .comment = '#'});
}

TEST(TextScanner, CountsEveryKindOfLineEndOnce) {
  TextScanner scanner = scan("a\nb\r\nc\rd\n\r\ne");

  for (const auto& [word, line] : {std::pair{"a", 1}, {"b", 2}, {"c", 3}, {"d", 4}, {"e", 6}}) {
    EXPECT_EQ(scanner.word(), word);
    EXPECT_EQ(scanner.line(), line);
  }
  EXPECT_TRUE(scanner.at_end());
}

TEST(TextScanner, SplitsWordsAtMarksAndComments) {
  TextScanner scanner = scan("foo{bar}#comment } x\n }");

  for (const char* word : {"foo", "{", "bar", "}", "}", ""}) EXPECT_EQ(scanner.word(), word);
}

TEST(TextScanner, AcceptsWholeWordsOnlyUnlessAColonEndsThem) {
  EXPECT_FALSE(scan("ENDING").accept("End"));
  EXPECT_TRUE(scan("END site").accept("End"));
  EXPECT_TRUE(scan("end").accept("End"));
  EXPECT_TRUE(scan("Frames:12").accept("Frames:"));
  EXPECT_FALSE(scan("EN").accept("End"));
}

TEST(TextScanner, ReadsNumbersOfEverySpelling) {
  TextScanner scanner = scan("1 -2.5 +3 .5 5. 1e3 -1.5E-2 +1e+2 007");

  for (const double value : {1.0, -2.5, 3.0, 0.5, 5.0, 1000.0, -0.015, 100.0, 7.0})
    EXPECT_EQ(scanner.number(), value);
}

TEST(TextScanner, RejectsWhatIsNotANumber) {
  for (const char* text : {"x", "1x", "1,5", "--1", "+-1", "+", "-", ".", "0x10", "1e", "1e999"})
    EXPECT_THROW(scan(text).number(), FileError) << text;
  for (const char* text : {"nan", "inf", "-inf", "NaN"}) {
    EXPECT_THROW(scan(text).number(), FileError) << text;
    EXPECT_NO_THROW(scan(text).number_or_nan()) << text;
  }
  for (const char* text : {"-1", "1.5", "99999999999999999999", "1e3", ""})
    EXPECT_THROW(scan(text).count(), FileError) << text;
}

TEST(TextScanner, ShortensAndCleansWhatItQuotes) {
  EXPECT_EQ(excerpt(std::string(40, 'a')), "'" + std::string(32, 'a') + "...'");
  EXPECT_EQ(excerpt(std::string_view("a\0\x1B", 3)), R"('a\x00\x1B')");
}

TEST(TextScanner, NamesFileLineExpectationAndFinding) {
  TextScanner scanner = scan("a\n\n  b");
  scanner.word();

  EXPECT_THAT([&] { scanner.expect("MOTION"); },
              ThrowsMessage<FileError>(StrEq("x:3: expected MOTION, found 'b'")));
}

}  // namespace
}  // namespace moclean
