#include "moclean/filter/interpolate.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include "moclean/core/specification.hpp"

#include "filter/signal.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

using test::expect_samples;
using test::rough_wave;
using test::smoothed;
using Kind = Interpolate::Kind;

using test::nan;

// Gaps of one sample up to seven, and at both ends.
std::vector<double> holey_wave() {
  auto y = rough_wave();
  for (const std::size_t i :
       {0, 1, 4, 8, 9, 10, 11, 12, 18, 20, 21, 30, 31, 32, 33, 34, 35, 36, 39})
    y[i] = nan;
  return y;
}

void expect_channel(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], test::tolerance::scipy()) << "frame " << i;
}

TEST(Interpolate, LinearAgreesWithNumpy) {  // numpy.interp, NumPy 1.24.2
  expect_samples(smoothed(Interpolate{}, holey_wave()), {{4, 8.90410948115769},
                                                         {8, 6.58046779010066},
                                                         {12, -3.22603571545166},
                                                         {18, 5.51749887537315},
                                                         {20, -1.96609907227299},
                                                         {21, -0.425342718569605},
                                                         {30, 4.90779002796412},
                                                         {36, -7.82362360918217}});
}

TEST(Interpolate, CubicAgreesWithScipy) {  // CubicSpline(t, y, bc_type='natural'), SciPy 1.10.1
  expect_samples(smoothed(Interpolate{.kind = Kind::cubic}, holey_wave()),
                 {{4, 9.60563262074026},
                  {8, 9.7479015063409},
                  {10, 7.31086536361567},
                  {12, -0.133859069146153},
                  {18, 12.6537700965378},
                  {20, -9.24043283370985},
                  {21, -5.31949046095769},
                  {30, 6.41568409907924},
                  {33, -2.62298131073588},
                  {36, -10.3509491354083}});
  expect_channel(smoothed(Interpolate{.kind = Kind::cubic}, {1, nan, 2, nan, nan, 2.2}),
                 {1, 1.565, 2, 2.21111111111111, 2.24888888888889, 2.2});
}

TEST(Interpolate, PchipAgreesWithScipy) {  // PchipInterpolator(t, y), SciPy 1.10.1
  expect_samples(smoothed(Interpolate{.kind = Kind::pchip}, holey_wave()),
                 {{4, 8.90410948115769},
                  {8, 8.4233030587188},
                  {10, 4.27364885869826},
                  {12, -2.18394562698785},
                  {18, 5.51749887537315},
                  {20, -2.85439001178701},
                  {21, -1.17475369512872},
                  {30, 5.94667967138885},
                  {33, -1.91977308205476},
                  {36, -9.26663750762193}});
}

// The same function: the slope of the first end as it is, zero, and limited to three secants.
TEST(Interpolate, PchipAgreesWithScipyAtTheEnds) {
  const Interpolate pchip{.kind = Kind::pchip};
  expect_channel(smoothed(pchip, {1, nan, 2, nan, nan, 2.2}),
                 {1, 1.63734159779614, 2, 2.10694827058463, 2.17569635751454, 2.2});
  expect_channel(smoothed(pchip, {1, nan, nan, nan, 1.5, nan, 9}),
                 {1, 1.0275, 1.115, 1.27, 1.5, 4.07791666666667, 9});
  expect_channel(smoothed(pchip, {1, nan, nan, 2, nan, nan, nan, nan, nan, -40}),
                 {1, 1.7037037037037, 1.96296296296296, 2, 0.540123456790123, -3.60493827160494,
                  -10.0833333333333, -18.5432098765432, -28.6327160493827, -40});
}

class InterpolateKind : public testing::TestWithParam<Kind> {
 protected:
  const Interpolate filter_{.kind = GetParam()};
};

TEST_P(InterpolateKind, LeavesObservedSamplesAndHoldsTheEnds) {
  const auto y = holey_wave();

  const auto z = smoothed(filter_, y);

  for (std::size_t i = 0; i < y.size(); ++i)
    if (!std::isnan(y[i])) {
      EXPECT_EQ(z[i], y[i]) << i;
    }
  EXPECT_EQ(z[0], y[2]);
  EXPECT_EQ(z[1], y[2]);
  EXPECT_EQ(z[39], y[38]);
  EXPECT_EQ(smoothed(filter_, rough_wave()), rough_wave());
}

TEST_P(InterpolateKind, ReversesWithTheChannel) {
  auto y = holey_wave();
  const auto z = smoothed(filter_, y);
  std::ranges::reverse(y);

  auto back = smoothed(filter_, y);

  std::ranges::reverse(back);
  expect_channel(back, z);
}

TEST_P(InterpolateKind, MakesTheLineOfTwoSamplesAndHoldsOne) {
  expect_channel(smoothed(filter_, {nan, 1, nan, nan, nan, 9, nan}), {1, 1, 3, 5, 7, 9, 9});
  EXPECT_EQ(smoothed(filter_, {nan, nan, 4, nan}), std::vector<double>(4, 4));
  EXPECT_TRUE(smoothed(filter_, {}).empty());
  for (const double x : smoothed(filter_, std::vector<double>(3, nan))) EXPECT_TRUE(std::isnan(x));
}

TEST_P(InterpolateKind, KeepsAStraightLine) {
  std::vector<double> line, holey;
  for (int t = 0; t < 30; ++t) line.push_back(3 - 0.75 * t);
  holey = line;
  for (const std::size_t i : {1, 5, 6, 7, 15, 16, 28}) holey[i] = nan;
  expect_channel(smoothed(filter_, holey), line);
}

INSTANTIATE_TEST_SUITE_P(All, InterpolateKind,
                         testing::Values(Kind::linear, Kind::cubic, Kind::pchip),
                         [](const auto& kind) {
                           return std::string(
                               Interpolate::kinds[static_cast<std::size_t>(kind.param)]);
                         });

TEST(Interpolate, PchipOvershootsNeitherSide) {
  const auto y = holey_wave();
  const auto z = smoothed(Interpolate{.kind = Kind::pchip}, y);
  std::size_t before = 2;
  for (std::size_t i = 3; i < 39; ++i) {
    if (std::isnan(y[i])) continue;
    for (std::size_t gap = before + 1; gap < i; ++gap) {
      EXPECT_GE(z[gap], std::min(y[before], y[i])) << gap;
      EXPECT_LE(z[gap], std::max(y[before], y[i])) << gap;
    }
    before = i;
  }
}

TEST(Interpolate, IsReadAndWritten) {
  const auto read = [](const char* text) {
    return read_parameters<Interpolate>(Specification("method", text));
  };
  EXPECT_EQ(read("interpolate"), Interpolate{.kind = Kind::linear});
  EXPECT_EQ(read("interpolate:kind=pchip"), Interpolate{.kind = Kind::pchip});
  EXPECT_EQ(to_specification(Interpolate{.kind = Kind::cubic}), "interpolate:kind=cubic");
}

}  // namespace
}  // namespace moclean
