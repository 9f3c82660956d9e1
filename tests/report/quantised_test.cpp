#include "moclean/report/quantised.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::nan;

TEST(Quantise, UsesTheWholeRangeOfCodes) {
  Matrix column(3, 1);
  column << -2, 0.5, 3;

  const Quantised quantised = quantise(column);

  EXPECT_THAT(quantised.codes, testing::ElementsAre(-32767, 0, 32767));
  EXPECT_EQ(quantised.offset[0], 0.5);
  EXPECT_EQ(quantised.step[0], 2.5 / 32767);
}

TEST(Quantise, IsOffByHalfAStepAtMost) {
  Matrix matrix = test::random_matrix(500, 7, 3);
  matrix.col(2) *= 1e6;
  matrix.col(3).setConstant(-4);
  matrix.col(4).array() += 1e4;

  const Quantised quantised = quantise(matrix);
  const Matrix restored = restore(quantised);

  for (Index c = 0; c < matrix.cols(); ++c) {
    const double step = quantised.step[static_cast<std::size_t>(c)];
    const double range = matrix.col(c).maxCoeff() - matrix.col(c).minCoeff();
    EXPECT_NEAR(step, range / 65534, test::tolerance::by_hand(range));
    EXPECT_LE(test::largest_difference(matrix.col(c), restored.col(c)),
              step / 2 + test::tolerance::by_hand(matrix.col(c).cwiseAbs().maxCoeff()));
  }
  EXPECT_EQ(restored(17, 3), -4);
}

TEST(Quantise, KeepsGapsAsGaps) {
  Matrix matrix(3, 2);
  matrix << 1, nan, nan, nan, 3, nan;

  const Matrix restored = restore(quantise(matrix));

  EXPECT_EQ(restored(0, 0), 1);
  EXPECT_TRUE(std::isnan(restored(1, 0)));
  EXPECT_EQ(restored(2, 0), 3);
  for (Index r = 0; r < 3; ++r) EXPECT_TRUE(std::isnan(restored(r, 1)));
}

TEST(Quantise, TakesTheLargestNumbersAndInfinities) {
  constexpr double most = std::numeric_limits<double>::max();
  Matrix matrix(3, 1);
  matrix << -most, most, std::numeric_limits<double>::infinity();

  const Quantised quantised = quantise(matrix);

  EXPECT_THAT(quantised.codes, testing::ElementsAre(-32767, 32767, Quantised::missing));
  EXPECT_TRUE(std::isfinite(quantised.step[0]));
}

// RFC 4648, section 10.
TEST(Base64, AgreesWithTheStandard) {
  const auto encoded = [](std::string_view text) {
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    return base64(bytes);
  };

  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(encoded("fooba"), "Zm9vYmE=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

// 0x0102 and -2 = 0xfffe: bytes 02 01 fe ff.
TEST(Base64, PutsTheLowByteFirst) {
  const std::vector<std::int16_t> codes = {0x0102, -2};

  EXPECT_EQ(base64(codes), "AgH+/w==");
}

}  // namespace
}  // namespace moclean
