#include "moclean/noise/gaussian_frames.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

// The noise alone: what is added to zeros.
Matrix noise_alone(const GaussianFrames& noise, Index frames, Index columns, std::uint64_t seed) {
  Recording clip{.samples = Matrix::Zero(frames, columns),
                 .columns = default_column_names(columns),
                 .unit = ""};
  Random random(seed);
  add_noise(noise, random, clip);
  return clip.samples;
}

Index frames_changed(const Matrix& added) { return (added.array() != 0).rowwise().any().count(); }

TEST(GaussianFrames, TouchesExactlyTheFramesAskedFor) {
  // 93 columns: a chosen frame stays untouched with probability 2^-93.
  EXPECT_EQ(frames_changed(noise_alone({.frames = 40}, 200, 93, 1)), 40);
  EXPECT_EQ(frames_changed(noise_alone({.frames = 0}, 200, 93, 1)), 0);
  EXPECT_EQ(frames_changed(noise_alone({.frames = 200}, 200, 93, 1)), 200);
}

TEST(GaussianFrames, RoundsAFractionToWholeFrames) {
  EXPECT_EQ(frames_changed(noise_alone({.fraction = 0.25}, 10, 93, 1)), 3);  // 2.5
  EXPECT_EQ(frames_changed(noise_alone({.fraction = 0.24}, 10, 93, 1)), 2);
  EXPECT_EQ(frames_changed(noise_alone({.fraction = 1}, 10, 93, 1)), 10);
}

TEST(GaussianFrames, TouchesHalfTheEntriesOfAChosenFrame) {
  const Matrix added = noise_alone({.frames = 2000}, 2000, 93, 7);

  const auto share = (added.array() != 0).cast<double>().mean();
  EXPECT_NEAR(share, 0.5, test::tolerance::five_standard_errors(0.5, 2000 * 93));
}

TEST(GaussianFrames, AddsTheMeanAndTheStandardDeviationAskedFor) {
  const Matrix added = noise_alone({.frames = 2000, .mean = 1, .sd = 1.2}, 2000, 93, 7);

  const auto count = static_cast<double>((added.array() != 0).count());
  const double mean = added.sum() / count;
  const double sd = std::sqrt(added.squaredNorm() / count - mean * mean);
  EXPECT_NEAR(mean, 1, test::tolerance::five_standard_errors(1.2, count));
  EXPECT_NEAR(sd, 1.2, test::tolerance::five_standard_errors(1.2 / std::sqrt(2), count));
}

TEST(GaussianFrames, AddsTheMeanAloneWithoutDeviation) {
  const Matrix added = noise_alone({.frames = 50, .mean = -3, .sd = 0}, 50, 20, 2);

  EXPECT_TRUE(((added.array() == 0) || (added.array() == -3)).all());
}

TEST(GaussianFrames, TreatsColumnsIndependently) {
  constexpr Index frames = 4000;
  const Matrix added = noise_alone({.frames = frames}, frames, 6, 11);

  const Matrix centred = added.rowwise() - added.colwise().mean();
  for (Index i = 0; i < 6; ++i)
    for (Index j = 0; j < i; ++j) {
      const double correlation =
          centred.col(i).dot(centred.col(j)) / (centred.col(i).norm() * centred.col(j).norm());
      EXPECT_NEAR(correlation, 0, test::tolerance::five_standard_errors(1, frames))
          << "columns " << i << " and " << j;
    }
}

TEST(GaussianFrames, DoesNotDependOnTheSamples) {
  Matrix clean = test::random_matrix(30, 9, 3);
  clean(4, 5) = test::nan;
  Recording noisy{.samples = clean, .columns = default_column_names(9), .unit = ""};
  Random random(5);

  add_noise(GaussianFrames{.frames = 30}, random, noisy);

  const Matrix alone = noise_alone({.frames = 30}, 30, 9, 5);
  Matrix expected = clean + alone;
  expected(4, 5) = clean(4, 5);
  EXPECT_TRUE(test::same_bits(noisy.samples, expected));
}

// Printed once by this code and kept: a platform on which they differ breaks reproducibility.
TEST(GaussianFrames, IsTheSameBitsEverywhere) {
  const Matrix added = noise_alone({.frames = 2, .mean = 1, .sd = 1.2}, 4, 3, 2026);

  Matrix expected(4, 3);
  expected << 0x1.c4fe65bdd9f85p-1, 0, 0,                                //
      0x1.80805fa6bbdcp+0, -0x1.eb55f8c2ebb3p-4, -0x1.6ad38ee2fba5ap+0,  //
      0, 0, 0,                                                           //
      0, 0, 0;
  EXPECT_TRUE(test::same_bits(added, expected)) << added;
}

TEST(GaussianFrames, RefusesMoreFramesThanThereAre) {
  EXPECT_THAT([] { noise_alone({.frames = 11}, 10, 3, 1); },
              ThrowsMessage<ArgumentError>(
                  "gaussian-frames: frames is 11, but the clip has only 10 frames"));
}

TEST(GaussianFrames, RefusesParametersOutOfRange) {
  EXPECT_THAT([] { noise_alone({.frames = -2}, 10, 3, 1); },
              ThrowsMessage<ArgumentError>(HasSubstr("frames is -2, expected at least 0")));
  EXPECT_THAT([] { noise_alone({.fraction = 1.5}, 10, 3, 1); },
              ThrowsMessage<ArgumentError>(HasSubstr("fraction is 1.5, expected 0 to 1")));
  EXPECT_THAT([] { noise_alone({.frames = 1, .sd = -1}, 10, 3, 1); },
              ThrowsMessage<ArgumentError>(HasSubstr("sd is -1, expected at least 0")));
  EXPECT_THAT([] { noise_alone({.frames = 1, .mean = std::nan("")}, 10, 3, 1); },
              ThrowsMessage<ArgumentError>(HasSubstr("mean is nan, expected a number")));
}

}  // namespace
}  // namespace moclean
