#include "moclean/noise/noise.hpp"

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean {
namespace {

using testing::ThrowsMessage;

void expect_refused(const std::string& specification, const std::string& message) {
  EXPECT_THAT([&] { parse_noise(specification); }, ThrowsMessage<ArgumentError>(message))
      << specification;
}

TEST(ParseNoise, ReadsEveryKeyInAnyOrder) {
  EXPECT_EQ(parse_noise("gaussian-frames:frames=400,mean=1,sd=1.2"),
            Noise(GaussianFrames{.frames = 400, .mean = 1, .sd = 1.2}));
  EXPECT_EQ(parse_noise("gaussian-frames:sd=0.5,mean=-2e1,fraction=0.3"),
            Noise(GaussianFrames{.fraction = 0.3, .mean = -20, .sd = 0.5}));
}

TEST(ParseNoise, DefaultsToThePapersMeanAndDeviation) {
  EXPECT_EQ(parse_noise("gaussian-frames:frames=7"),
            Noise(GaussianFrames{.frames = 7, .mean = 1, .sd = 1.2}));
}

TEST(ParseNoise, ReadsBackWhatToStringWrites) {
  for (const GaussianFrames& noise :
       {GaussianFrames{.frames = 0}, GaussianFrames{.frames = 400, .mean = -0.1, .sd = 1.0 / 3},
        GaussianFrames{.fraction = 0.1, .mean = 1e-300, .sd = 1e300}})
    EXPECT_EQ(parse_noise(to_string(Noise(noise))), Noise(noise)) << to_string(noise);

  EXPECT_EQ(to_string(Noise(GaussianFrames{.frames = 400})),
            "gaussian-frames:frames=400,mean=1,sd=1.2");
}

TEST(ParseNoise, NamesWhatIsWrongAndWhatWouldBeRight) {
  const std::string all =
      "gaussian-frames, gaussian, dropout, burst, gap, swap, drift, ramp, "
      "jitter, round, white, limb-swap, inertial-drift";
  expect_refused("salt:frames=1", "unknown noise 'salt', expected one of " + all);
  expect_refused("", "unknown noise '', expected one of " + all);
  expect_refused("gaussian-frames:frame=4",
                 "noise gaussian-frames: unknown key 'frame', expected one of frames, fraction, "
                 "mean, sd");
  expect_refused("gaussian-frames:frames=4,frames=5",
                 "noise gaussian-frames: frames is given twice");
  expect_refused("gaussian-frames:frames=4,fraction=0.1",
                 "gaussian-frames takes frames= or fraction=, not both");
  expect_refused("gaussian-frames",
                 "gaussian-frames needs frames=COUNT or fraction=SHARE, for instance "
                 "gaussian-frames:frames=400");
}

TEST(ParseNoise, RefusesPartsThatAreNotKeyAndValue) {
  expect_refused("gaussian-frames:", "noise gaussian-frames: expected key=value, found ''");
  expect_refused("gaussian-frames:frames",
                 "noise gaussian-frames: expected key=value, found "
                 "'frames'");
  expect_refused("gaussian-frames:=4", "noise gaussian-frames: expected key=value, found '=4'");
  expect_refused("gaussian-frames:frames=4,",
                 "noise gaussian-frames: expected key=value, found ''");
}

TEST(ParseNoise, RefusesValuesThatAreNotTheNumberExpected) {
  for (const char* count : {"", "x", "4x", "-1", "1.5", "99999999999999999999"})
    expect_refused(std::string("gaussian-frames:frames=") + count,
                   std::string("noise gaussian-frames: frames is '") + count +
                       "', expected a whole number of at least 0");
  for (const char* number : {"", "x", "1.2.3", "nan", "inf", "1e999"})
    expect_refused(
        std::string("gaussian-frames:frames=1,mean=") + number,
        std::string("noise gaussian-frames: mean is '") + number + "', expected a number");
  expect_refused("gaussian-frames:frames=1,sd=-2",
                 "gaussian-frames: sd is -2, expected at least 0");
  expect_refused("gaussian-frames:fraction=2", "gaussian-frames: fraction is 2, expected 0 to 1");
}

TEST(ParseNoise, ReadsEveryModel) {
  EXPECT_EQ(parse_noise("gaussian:snr=20"), Noise(Gaussian{.snr = 20.0}));
  EXPECT_EQ(parse_noise("dropout:fill=nan,fraction=0.4"),
            Noise(Dropout{.fraction = 0.4, .fill = Dropout::Fill::nan}));
  EXPECT_EQ(parse_noise("burst:count=3,length=40,sd=2"),
            Noise(Burst{.runs = {.count = 3, .length = 40}, .sd = 2}));
  EXPECT_EQ(parse_noise("gap:fraction=0.1"), Noise(Gap{.runs = {.fraction = 0.1}}));
  EXPECT_EQ(parse_noise("swap:count=2"), Noise(Swap{.runs = {.count = 2}}));
  EXPECT_EQ(parse_noise("drift:count=2,sd=9"), Noise(Drift{.runs = {.count = 2}, .sd = 9}));
  EXPECT_EQ(parse_noise("ramp:count=2,sd=9"), Noise(Ramp{.runs = {.count = 2}, .sd = 9}));
  EXPECT_EQ(parse_noise("jitter:sd=2,cutoff=3"), Noise(Jitter{.sd = 2.0, .cutoff = 3.0}));
  EXPECT_EQ(parse_noise("round:step=2"), Noise(Round{.step = 2.0}));
  EXPECT_EQ(parse_noise("white:sd-mm=2,unit-mm=10"), Noise(White{.sd_mm = 2.0, .unit_mm = 10.0}));
  EXPECT_EQ(parse_noise("limb-swap:count=2"), Noise(LimbSwap{.runs = {.count = 2}}));
  EXPECT_EQ(parse_noise("inertial-drift:sd=2"), Noise(InertialDrift{.sd = 2.0}));
  for (const char* text :
       {"gaussian:sd=0.1", "dropout:fraction=0.1,fill=nan,background=none,snr=15",
        "burst:count=3,length=40,sd=2", "swap:fraction=0.25,length=60", "jitter:sd=0.5,cutoff=6",
        "round:step=0.01", "white:sd-mm=3", "white:sd-mm=3,unit-mm=25.4",
        "limb-swap:count=1,length=20", "inertial-drift:sd=2,of=limb"})
    EXPECT_EQ(to_string(parse_noise(text)), text);
}

TEST(Corrupt, EveryModelRepeatsWithTheSeedAndKeepsToItsMask) {
  Recording walk = test::synthetic_walk(100);
  for (std::size_t c = 0; c < 3; ++c) {  // a limb in two
    walk.columns[3 + c].replace(0, 6, "lfoot");
    walk.columns[6 + c].replace(0, 6, "rfoot");
  }
  for (const char* model :
       {"gaussian-frames:frames=20", "gaussian:snr=10", "dropout:background=none,fill=nan",
        "burst:count=4,length=20", "gap:count=4,length=20", "swap:count=4,length=20",
        "drift:count=4,length=20", "ramp:count=4,length=20", "jitter:sd=0.3,cutoff=6",
        "white:sd-mm=3,unit-mm=56.4", "limb-swap:count=1,length=20", "inertial-drift:sd=3",
        "inertial-drift:sd=3,of=limb"}) {
    const Noise noise = parse_noise(model);

    const Corrupted noisy = corrupt(walk, noise, 3), again = corrupt(walk, noise, 3);

    EXPECT_TRUE(test::same_bits(noisy.clip.samples, again.clip.samples)) << model;
    EXPECT_FALSE(test::same_bits(noisy.clip.samples, corrupt(walk, noise, 4).clip.samples));
    EXPECT_TRUE((noisy.touched == again.touched).all()) << model;
    const Mask differs = noisy.clip.samples.array() != walk.samples.array();
    EXPECT_GT(differs.count(), 0) << model;
    EXPECT_TRUE((differs == noisy.touched).all()) << model;
  }
}

TEST(Corrupt, MarksExactlyTheEntriesThatDiffer) {
  const Recording walk = test::synthetic_walk(120);

  const Corrupted noisy = corrupt(walk, GaussianFrames{.frames = 40}, 1);

  ASSERT_EQ(noisy.touched.rows(), 120);
  ASSERT_EQ(noisy.touched.cols(), 93);
  EXPECT_EQ(noisy.touched.rowwise().any().count(), 40);
  for (Index i = 0; i < walk.samples.size(); ++i)
    ASSERT_EQ(noisy.touched.data()[i], noisy.clip.samples.data()[i] != walk.samples.data()[i]);
}

TEST(Corrupt, LeavesNaNAloneAndUntouched) {
  Recording walk = test::synthetic_walk(10);
  walk.samples.row(3).setConstant(test::nan);

  const Corrupted noisy = corrupt(walk, GaussianFrames{.frames = 10}, 1);

  EXPECT_TRUE(test::same_bits(noisy.clip.samples.row(3), walk.samples.row(3)));
  EXPECT_FALSE(noisy.touched.row(3).any());
  EXPECT_EQ(noisy.touched.rowwise().any().count(), 9);
}

TEST(Corrupt, KeepsNamesRateAndUnit) {
  Recording walk = test::synthetic_walk(5);
  walk.unit = "mm";

  const Recording noisy = corrupt(walk, GaussianFrames{.frames = 1}, 1).clip;

  EXPECT_EQ(noisy.columns, walk.columns);
  EXPECT_EQ(noisy.frame_rate, 120);
  EXPECT_EQ(noisy.unit, "mm");
}

TEST(Corrupt, RepeatsWithTheSeedAndDiffersWithout) {
  const Recording walk = test::synthetic_walk(50);
  const GaussianFrames noise{.frames = 10};

  const Matrix first = corrupt(walk, noise, 4).clip.samples;

  EXPECT_TRUE(test::same_bits(first, corrupt(walk, noise, 4).clip.samples));
  EXPECT_FALSE(test::same_bits(first, corrupt(walk, noise, 5).clip.samples));
}

TEST(NoiseChain, ReadsBackWhatToStringWrites) {
  const NoiseChain chain = parse_noise_chain("gap:count=2,length=10+gaussian-frames:fraction=1e-1");

  ASSERT_EQ(chain.size(), 2U);
  EXPECT_EQ(chain[0], Noise(Gap{{.count = 2, .length = 10}}));
  EXPECT_EQ(parse_noise_chain(to_string(chain)), chain);
  EXPECT_THAT([] { parse_noise_chain("gap:count=1+"); },
              ThrowsMessage<ArgumentError>(testing::HasSubstr("unknown noise ''")));
  EXPECT_THAT([] { corrupt(test::synthetic_walk(5), NoiseChain{}, 1); },
              ThrowsMessage<ArgumentError>("a chain needs at least one noise"));
}

TEST(NoiseChain, AddsEachToWhatTheOneBeforeLeft) {
  const Recording walk = test::synthetic_walk(40);
  const Gap gap{{.count = 3, .length = 20}};

  const Corrupted gaps = corrupt(walk, gap, 5);
  const Corrupted both = corrupt(walk, NoiseChain{gap, GaussianFrames{.fraction = 0.5}}, 5);

  const Mask missing = gaps.clip.samples.array().isNaN();
  EXPECT_TRUE((both.clip.samples.array().isNaN() == missing).all());
  EXPECT_TRUE((both.touched || !gaps.touched).all());
  EXPECT_GT((both.touched && !missing).count(), 40 * 93 / 8);
  EXPECT_TRUE((both.clip.samples.array() == walk.samples.array() || both.touched).all());
}

TEST(Noise, RefusesToMakeNumbersThatNoMethodTakes) {
  const Recording walk = test::synthetic_walk(50);
  for (const char* noise : {"gaussian:sd=1e300", "gaussian-frames:frames=9,mean=1e200,sd=1",
                            "burst:count=1,length=3,sd=1e300", "inertial-drift:sd=1e300"})
    EXPECT_THROW(corrupt(walk, parse_noise(noise), 1), ArgumentError) << noise;
}

TEST(Noise, OfRunsIsBoundedByTheTake) {
  const Recording walk = test::synthetic_walk(50);
  for (const char* noise :
       {"burst:count=9223372036854775807,length=5,sd=1", "gap:count=1000000000000,length=1",
        "swap:count=1000000000,length=2", "drift:count=1000000000,length=2,sd=1"})
    EXPECT_THROW(corrupt(walk, parse_noise(noise), 1), ArgumentError) << noise;
}

}  // namespace
}  // namespace moclean
