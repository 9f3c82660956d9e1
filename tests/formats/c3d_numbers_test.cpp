#include "moclean/formats/c3d_numbers.hpp"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "support/nan.hpp"

namespace moclean {
namespace {

std::string text(const auto& bytes) { return {bytes.data(), bytes.size()}; }

TEST(C3dNumbers, AreThoseOfTheProcessor) {
  const C3dNumbers intel(C3dProcessor::intel), dec(C3dProcessor::dec), mips(C3dProcessor::mips);

  EXPECT_EQ(intel.integer("\x02\x01"), 258);
  EXPECT_EQ(dec.integer("\x02\x01"), 258);
  EXPECT_EQ(mips.integer("\x02\x01"), 513);
  EXPECT_EQ(mips.integer("\xFF\xFE"), -2);
  EXPECT_EQ(intel.word("\xFE\xFF"), 65534u);
  EXPECT_EQ(intel.real("\x00\x00\x80\x3F"), 1);
  EXPECT_EQ(mips.real("\x3F\x80\x00\x00"), 1);
}

// VAX Architecture Handbook: 1 is 0000 4080 in hexadecimal, low word at the right.
TEST(C3dNumbers, OfDecAreThoseOfTheVax) {
  const C3dNumbers dec(C3dProcessor::dec);

  EXPECT_EQ(dec.real("\x80\x40\x00\x00"), 1);
  EXPECT_EQ(dec.real("\x80\xC0\x00\x00"), -1);
  EXPECT_EQ(dec.real("\x20\x42\x00\x00"), 10);
  EXPECT_EQ(dec.real("\x00\x00\x00\x00"), 0);
  EXPECT_TRUE(std::isnan(dec.real("\x00\x80\x00\x00")));
  EXPECT_EQ(dec.real("\xFF\x7F\xFF\xFF"), dec.largest());
}

TEST(C3dNumbers, AreReadAsTheyWereWritten) {
  for (const auto processor : {C3dProcessor::intel, C3dProcessor::dec, C3dProcessor::mips}) {
    const C3dNumbers numbers(processor);
    for (const double value : {0.0, 1.0, -1.0, 0.1, -1234.5678, 1e-30, 3e37, numbers.largest(),
                               -numbers.largest(), 16777215.0, 0.99999997}) {
      const double stored = numbers.real(numbers.real_bytes(value).data());

      EXPECT_NEAR(stored, value, std::abs(value) * std::numeric_limits<float>::epsilon() / 2);
      EXPECT_EQ(text(numbers.real_bytes(stored)), text(numbers.real_bytes(value)));
    }
    EXPECT_TRUE(std::isnan(numbers.real(numbers.real_bytes(test::nan).data())));
    EXPECT_LT(numbers.real(numbers.real_bytes(1e-45).data()), 1e-44);
    EXPECT_EQ(numbers.word(numbers.word_bytes(54321).data()), 54321u);
  }
}

}  // namespace
}  // namespace moclean
