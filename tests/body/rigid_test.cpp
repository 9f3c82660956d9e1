#include <algorithm>
#include <cmath>
#include <functional>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

#include "moclean/body/jump_flags.hpp"
#include "moclean/body/rigid_flags.hpp"
#include "moclean/body/splices.hpp"

#include "support/hand.hpp"
#include "support/limbs.hpp"
#include "support/nan.hpp"

namespace moclean {
namespace {

constexpr Index frames = 400, joints = 9;
constexpr double edge_floor = 1e-4;

// A take and what is learned from it.
struct Learned {
  explicit Learned(const Matrix& samples)
      : take(body_take(samples, 120)),
        size(body_size(take)),
        smallest(edge_floor * size),
        body(learn_rigid_body(take, smallest)) {}

  RigidFlags flags() const { return vote_on_joints(take, body, size, smallest); }
  Mask jumps(const Mask& trusted) const {
    return jump_flags(take, sudden_steps(take, trusted, least_sudden_step(size, smallest)), body);
  }
  Mask trusted() const {
    const RigidFlags found = flags();
    return found.consistent && !found.bad;
  }
  std::vector<Index> splice_frames() const {
    return splices(trusted(), sudden_steps(take, trusted(), least_sudden_step(size, smallest)),
                   body, jumps(trusted()));
  }

  BodyTake take;
  double size, smallest;
  RigidBody body;
};

// Random displacements of the whole samples of one joint.
Matrix displaced(Index joint, Index first, Index last, const Eigen::RowVector3d& by) {
  Matrix samples = test::swinging_limbs(frames, joints);
  samples.middleRows(first, last - first).middleCols(3 * joint, 3).rowwise() += by;
  return samples;
}

TEST(SteadyCore, IsTheShortestIntervalThatHoldsAThird) {
  std::vector<double> values;
  for (int i = 0; i < 15; ++i) values.push_back(5 + 0.01 * i);
  for (int i = 0; i < 15; ++i) values.push_back(20 + 3. * i);

  const Core core = steady_core(values);

  EXPECT_GE(core.centre, 5.05 - 1e-9);  // ten steps of 0.01 within 5 .. 5.14
  EXPECT_LE(core.centre, 5.09 + 1e-9);
  EXPECT_NEAR(core.spread, 0.05 / 0.4307, 1e-9);
}

TEST(SteadyCore, KnowsNothingFromTwentyValues) {
  const std::vector<double> values(20, 1.);

  EXPECT_TRUE(std::isinf(steady_core(values).spread));
}

TEST(SteadyCore, CountsByWeight) {
  // Forty alike that hardly count, and twenty others: a third of the weight is among those.
  std::vector<WeighedDistance> values(40, {1., 0.1});
  for (int i = 0; i < 20; ++i) values.push_back({7 + 0.01 * i, 1.});

  const Core core = steady_core(values);

  EXPECT_GT(core.centre, 7);
}

TEST(RigidBody, FindsTheBones) {
  const Learned learned(test::swinging_limbs(frames, joints));

  int bones = 0;
  for (const RigidEdge& edge : learned.body.edges) {
    if (!edge.exact) continue;
    ++bones;
    EXPECT_EQ(edge.first, (edge.second - 1) / 2);
    EXPECT_NEAR(edge.length, 1 + 0.1 * static_cast<double>(edge.second), 1e-9);
  }
  EXPECT_EQ(bones, joints - 1);
  EXPECT_TRUE(learned.body.is_rigid());
}

TEST(RigidBody, OfSoftMarkersJudgesNobody) {
  Matrix samples = test::swinging_limbs(frames, joints);
  Random random(5);
  for (Index i = 0; i < samples.rows(); ++i)  // skin that slides by up to 1 % slowly, each marker
    for (Index j = 0; j < samples.cols(); ++j)
      samples(i, j) += 0.03 * std::sin(0.05 * static_cast<double>(i) + static_cast<double>(7 * j));
  const Learned learned(samples);

  EXPECT_TRUE(learned.body.empty());
  EXPECT_FALSE(learned.flags().bad.any());
}

TEST(RigidFlags, BlameTheJointThatIsDisplacedAndNoOther) {
  const Learned learned(displaced(4, 100, 130, {0.8, -0.5, 0.4}));

  const RigidFlags flags = learned.flags();

  EXPECT_EQ(flags.bad.count(), flags.bad.col(4).count());
  EXPECT_TRUE(flags.bad.col(4).segment(100, 30).all());
  EXPECT_LE(flags.bad.col(4).count(), 34);  // holes are closed over a few frames at the ends
  EXPECT_FALSE((flags.bad && flags.confirmed).any());
}

TEST(RigidFlags, HoldForAnyUnitOfLength) {
  const Matrix samples = displaced(4, 100, 130, {0.8, -0.5, 0.4});
  const Learned metres(samples), millimetres(1000 * samples);

  EXPECT_TRUE((metres.flags().bad == millimetres.flags().bad).all());
  EXPECT_TRUE((metres.flags().confirmed == millimetres.flags().confirmed).all());
}

// Joints 1, 3 and 7 lie nearly on a line but for a third of the time, when the limb bends at joint
// 3: the distance from 1 to 7 hardly changes for two thirds of the take, and is never longer. More
// joints may lie where joint 1 does.
Matrix with_straight_limb(Index at_joint_1) {
  Matrix samples = test::swinging_limbs(frames, joints + at_joint_1);
  for (Index i = 0; i < frames; ++i) {
    const double t = static_cast<double>(i);
    const Eigen::Vector3d hip = samples.row(i).segment<3>(3), knee = samples.row(i).segment<3>(9);
    const Eigen::Vector3d along = (knee - hip).normalized(), across = along.unitOrthogonal();
    const double bend = 0.03 * std::sin(0.31 * t) + 0.3 * std::max(0., std::sin(0.05 * t) - 0.5);
    samples.row(i).segment<3>(21) = knee + 1.7 * (std::cos(bend) * along + std::sin(bend) * across);
    for (Index j = joints; j < joints + at_joint_1; ++j)
      samples.row(i).segment<3>(3 * j) = hip.transpose();
  }
  return samples;
}

TEST(RigidFlags, DoNotTakeAStraightLimbForABone) {
  EXPECT_FALSE(Learned(with_straight_limb(0)).flags().bad.any());
}

TEST(RigidFlags, CountJointsAtOnePlaceOnce) {
  EXPECT_FALSE(Learned(with_straight_limb(3)).flags().bad.any());
}

TEST(RigidFlags, LetAJointTurnAboutAnother) {
  // The thumb leaves its place in the hand, but keeps its distance from the wrist.
  Matrix samples = test::limbs_with_hand(frames);
  test::flip(test::thumb, 200, 240, samples);
  const RigidFlags flags = Learned(samples).flags();

  EXPECT_FALSE(flags.bad.any());
  EXPECT_TRUE(flags.confirmed.col(11).segment(200, 40).all());
}

TEST(RigidFlags, FindAThumbThatIsNotWhereItsBoneIs) {
  Matrix samples = test::limbs_with_hand(frames);
  samples.middleRows(200, 40).middleCols(33, 3).rowwise() += Eigen::RowVector3d(0.4, -0.5, 0.3);
  const Mask bad = Learned(samples).flags().bad;

  EXPECT_TRUE(bad.col(11).segment(200, 40).all());
  EXPECT_EQ(bad.count(), 40);
}

// Noise of 2 % of a bone, and joint 8, the end of a chain, that hangs on joint 3 alone.
Matrix noisy(Matrix samples, double deviation) {
  Random random(11);
  for (double& x : samples.reshaped()) x += deviation * random.normal();
  return samples;
}

Learned learned_of_noisy(const Matrix& samples, double deviation) {
  Learned learned(samples);
  learned.smallest = 1.4 * deviation;
  learned.body = learn_rigid_body(learned.take, learned.smallest);
  return learned;
}

TEST(RigidBody, IsNotLearnedFromStandingStill) {
  // Half of the take one posture, with noise; only bones hold their length in the other half.
  Matrix samples = test::swinging_limbs(frames, joints);
  for (Index i = 0; i < frames / 2; ++i) samples.row(i) = samples.row(frames / 2);
  const Learned learned = learned_of_noisy(noisy(samples, 0.01), 0.01);

  for (const RigidEdge& edge : learned.body.edges)
    if (edge.hard) {
      EXPECT_EQ(edge.first, (edge.second - 1) / 2);
    }
  EXPECT_FALSE(learned.flags().bad.any());
}

TEST(RigidBody, HasNoExactDistanceWhereRoundingMakesThem) {
  // Who hardly moves, rounded to a tenth of the shortest bone: most distances never change.
  Matrix samples = test::swinging_limbs(frames, joints);
  for (Index i = 1; i < frames; ++i)
    samples.row(i) = samples.row(0) + 0.02 * (samples.row(i) - samples.row(0));
  constexpr double step = 0.1;
  samples = (samples / step).array().round() * step;
  const double deviation = step / std::sqrt(12.);
  const BodyTake take = body_take(samples, 120);

  const RigidBody blind = learn_rigid_body(take, 1.4 * deviation);
  const RigidBody told = learn_rigid_body(take, 1.4 * deviation, deviation);

  EXPECT_TRUE(std::ranges::any_of(blind.edges, &RigidEdge::exact));
  EXPECT_FALSE(std::ranges::any_of(told.edges, &RigidEdge::exact));
}

TEST(SuddenSteps, AreNotMadeByDenseNoise) {
  const Matrix samples = noisy(test::swinging_limbs(frames, joints), 0.3);
  const BodyTake take = body_take(samples, 120);
  const Mask all = Mask::Constant(frames, joints, true);

  const double least = least_sudden_step(body_size(take), 1.4 * 0.3);

  for (const SuddenSteps& joint : sudden_steps(take, all, least))
    EXPECT_TRUE(std::ranges::none_of(joint.sudden, std::identity{}));
}

TEST(RigidFlags, ConfirmAJointWhoseBonesHoldHoweverItMoves) {
  // Joint 8 flips about joint 3 in one frame; the bone keeps its length.
  Matrix samples = test::swinging_limbs(frames, joints);
  const Eigen::RowVector3d pivot = samples.row(200).segment<3>(9);
  samples.row(200).segment<3>(24) = 2 * pivot - samples.row(200).segment<3>(24);
  const RigidFlags flags = Learned(samples).flags();

  EXPECT_TRUE(flags.confirmed(200, 8));
  EXPECT_TRUE(flags.confirmed.all());
}

TEST(RigidFlags, ConfirmNobodyInAFrameThatIsMostlyWrong) {
  // All joints but two are displaced, each another way: the bone of those two still holds.
  Matrix samples = test::swinging_limbs(frames, joints);
  for (Index j = 0; j < joints - 2; ++j)
    samples.row(200).segment<3>(3 * j) += Eigen::RowVector3d(1, -1.5, 0.7) * (1 + j % 4);
  samples.row(200).segment<3>(21) = samples.row(200).segment<3>(9);
  samples.row(200).segment<3>(21).x() += 1.7;  // joint 7 hangs on joint 3 by 1 + 0.1 * 7
  const RigidFlags flags = Learned(samples).flags();

  EXPECT_FALSE(flags.confirmed.row(200).any());
}

TEST(RigidFlags, NeedAJumpWhereNoDistanceIsExact) {
  // Joint 7 leaves along a slow curve and comes back: with noise no distance is exact.
  Matrix slow = test::swinging_limbs(frames, joints), sudden = slow;
  for (Index i = 150; i < 250; ++i) {
    const double shift = 0.3 * (1 - std::cos(2 * M_PI * static_cast<double>(i - 150) / 100));
    slow.row(i).segment<3>(21) += Eigen::RowVector3d(shift, shift, -shift);
    sudden.row(i).segment<3>(21) += Eigen::RowVector3d(0.6, 0.6, -0.6);
  }

  const Mask gradual = learned_of_noisy(noisy(slow, 0.01), 0.01).flags().bad;
  const Mask jumping = learned_of_noisy(noisy(sudden, 0.01), 0.01).flags().bad;

  EXPECT_LT(gradual.count(), 5);
  EXPECT_GE(jumping.col(7).segment(150, 100).count(), 95);
}

TEST(RigidFlags, SayNothingOfMissingJoints) {
  Matrix samples = test::swinging_limbs(frames, joints);
  samples.middleRows(50, 40).middleCols(9, 3).setConstant(test::nan);
  const Learned learned(samples);

  EXPECT_FALSE(learned.flags().bad.any());
  EXPECT_FALSE(learned.flags().confirmed.col(3).segment(50, 40).any());
}

TEST(JumpFlags, FindALimbThatLeavesAsAWholeAndComesBack) {
  // Joint 3 and those that hang on it, 7 and 8, leave together: their bones keep their lengths.
  Matrix samples = test::swinging_limbs(frames, joints);
  for (const Index j : {3, 7, 8})
    samples.middleRows(200, 50).middleCols(3 * j, 3).rowwise() += Eigen::RowVector3d(2, 1, -1.5);
  const Learned learned(samples);
  const Mask all = Mask::Constant(frames, joints, true);

  const Mask jumps = learned.jumps(all);

  for (const Index j : {3, 7, 8}) EXPECT_TRUE(jumps.col(j).segment(200, 50).all()) << j;
  EXPECT_EQ(jumps.count(), 150);
}

TEST(JumpFlags, AreNotRaisedByMotion) {
  const Learned learned(test::swinging_limbs(frames, joints));
  const Mask all = Mask::Constant(frames, joints, true);

  EXPECT_FALSE(learned.jumps(all).any());
}

TEST(JumpFlags, DoNotCountWhatIsForgotten) {
  Matrix samples = test::swinging_limbs(frames, joints);
  for (const Index j : {3, 7, 8})
    samples.middleRows(200, 50).middleCols(3 * j, 3).rowwise() += Eigen::RowVector3d(2, 1, -1.5);
  const Learned learned(samples);
  std::vector<SuddenSteps> steps =
      sudden_steps(learned.take, learned.trusted(), least_sudden_step(learned.size, 0));

  forget_steps_into(200, steps);

  EXPECT_FALSE(jump_flags(learned.take, steps, learned.body).any());
}

// The body in two motions: the first `at` frames of another one, then frames of its own.
Matrix joined(Index at) {
  Matrix samples = test::swinging_limbs(frames, joints);
  samples.topRows(at) = test::swinging_limbs(frames, joints, 2).topRows(at);
  return samples;
}

TEST(Cuts, AreWhereAnotherMotionBegins) {
  for (const Index at : {1, 150, 399})  // 1: a pose before the motion
    EXPECT_THAT(Learned(joined(at)).splice_frames(), testing::ElementsAre(at));
}

TEST(Cuts, AreNotInOneMotion) {
  for (const Index length : {Index{2}, frames})
    EXPECT_THAT(Learned(test::swinging_limbs(length, joints)).splice_frames(), testing::IsEmpty());
}

TEST(Cuts, LieBeforeASpoiltFrame) {
  Matrix samples = joined(150);
  for (Index j = 0; j < joints; ++j)
    samples.row(150).segment<3>(3 * j) += Eigen::RowVector3d(1, -1.5, 0.7) * (1 + j % 4);

  EXPECT_THAT(Learned(samples).splice_frames(), testing::ElementsAre(150));
}

TEST(Cuts, AreNotMadeByWrongSamples) {
  Matrix samples = test::swinging_limbs(frames, joints);
  for (Index j = 0; j < joints; ++j)  // a first frame without a right length
    samples.row(0).segment<3>(3 * j).array() += 1 + 0.5 * static_cast<double>(j);
  for (const Index j : {3, 7, 8})  // a third of the body leaves and comes back
    samples.middleRows(200, 50).middleCols(3 * j, 3).rowwise() += Eigen::RowVector3d(2, 1, -1.5);

  EXPECT_THAT(Learned(samples).splice_frames(), testing::IsEmpty());
}

}  // namespace
}  // namespace moclean
