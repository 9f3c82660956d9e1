#include "moclean/formats/plain_number.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "moclean/core/random.hpp"

namespace moclean {
namespace {

struct Reading {
  double value = 0;
  std::ptrdiff_t length = 0;  // characters taken; -1: not a plain number
};

Reading read(const std::string& text) {
  Reading reading;
  const char* const after = plain_number(text.data(), text.data() + text.size(), reading.value);
  reading.length = after ? after - text.data() : -1;
  return reading;
}

TEST(PlainNumber, ReadsDigitsAndStopsBehindThem) {
  EXPECT_EQ(read("-12.5 7").value, -12.5);
  EXPECT_EQ(read("-12.5 7").length, 5);
  EXPECT_EQ(read("007e3").value, 7);
  EXPECT_EQ(read("007e3").length, 3);
  EXPECT_EQ(read(".25").value, 0.25);
  EXPECT_EQ(read("3.").value, 3);
  EXPECT_EQ(read("3.").length, 2);
  EXPECT_EQ(read("1.2.3").length, 3);
  EXPECT_TRUE(std::signbit(read("-0").value));
}

TEST(PlainNumber, LeavesOtherSpellingsAlone) {
  for (const char* text : {"", "-", ".", "-.", "+1", "--1", "nan", "inf", "e5", " 1"})
    EXPECT_EQ(read(text).length, -1) << text;
}

TEST(PlainNumber, TakesAtMostFifteenDigits) {
  EXPECT_EQ(read("123456789012.345").value, 123456789012.345);
  EXPECT_EQ(read("1234567890123.456").length, -1);
  EXPECT_EQ(read("0.000000000000001").length, -1);
  EXPECT_EQ(read(std::string(400, '9')).length, -1);
}

TEST(PlainNumber, HasTheBitsOfFromChars) {
  Random random(7);
  int beyond_float = 0;
  for (int i = 0; i < 200000; ++i) {
    const std::uint64_t digits = 1 + random.below(15);
    std::string text = random.below(2) == 0 ? "" : "-";
    for (std::uint64_t d = 0; d < digits; ++d) text += static_cast<char>('0' + random.below(10));
    text.insert(text.size() - random.below(digits + 1), ".");
    double expected = 0;
    std::from_chars(text.data(), text.data() + text.size(), expected);

    const Reading reading = read(text);

    ASSERT_EQ(reading.length, static_cast<std::ptrdiff_t>(text.size())) << text;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(reading.value), std::bit_cast<std::uint64_t>(expected))
        << text;
    beyond_float += static_cast<double>(static_cast<float>(expected)) != expected;
  }
  EXPECT_GT(beyond_float, 100000);  // or the numbers are too easy
}

}  // namespace
}  // namespace moclean
