// Matrix-normal smoothing on every backend: what it promises, and the device against the reference.
#include <limits>
#include <span>
#include <vector>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/core/random.hpp"

#include "support/backends.hpp"
#include "support/matrix.hpp"
#include "support/model_motion.hpp"
#include "support/nan.hpp"
#include "support/synthetic_walk.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::BackendKind;
using test::nan;

// Motion with dense noise, gross errors and gaps, one of which is long enough for lengths to count.
Matrix hard_data(Index frames, Index columns, std::uint64_t seed) {
  Matrix data = test::synthetic_walk(frames, seed).samples.leftCols(std::min<Index>(columns, 93));
  if (columns > 93) {
    Matrix wider(frames, columns);
    wider << data, test::synthetic_walk(frames, seed + 9).samples.leftCols(columns - 93);
    data = wider;
  }
  Random random(seed);
  for (Index i = 0; i < data.size(); ++i) {
    double& x = data.data()[i];
    x += 0.02 * random.normal();
    if (random.uniform() < 0.05) x += 3;
    if (random.uniform() < 0.05) x = nan;
  }
  if (frames >= 60 && columns >= 9) data.block(frames / 4, 3, 15, 3).setConstant(nan);
  return data;
}

SegmentBatch batch_of(const std::vector<Index>& lengths, Index columns) {
  std::vector<Matrix> segments;
  for (const Index length : lengths)
    segments.push_back(hard_data(length, columns, segments.size() + 1));
  return test::batch_of(segments);
}

// Links that hold nowhere in particular, doubtful confirmations, gaps expected at one place: all
// branches, no sense.
std::vector<MotionPrior> priors_of(const SegmentBatch& data) {
  std::vector<MotionPrior> priors;
  for (Index b = 0; b < data.segments(); ++b) {
    const Index joints = data.columns() / 3;
    MotionPrior known{
        .size = 10, .noise = 0.05, .confirmed = Mask::Constant(data.rows(b), joints, true)};
    for (Index j = 1; j < joints; ++j) known.links.push_back({j - 1, j, 5, true, j % 2 == 0});
    known.positions = Matrix::Constant(data.rows(b), data.columns(), 2);
    known.variance = Matrix::Constant(data.rows(b), joints, 0.5);
    known.variance.topRows(data.rows(b) / 2).setConstant(std::numeric_limits<double>::infinity());
    priors.push_back(known);
  }
  return priors;
}

// A joint missing for one frame or 15, here and there.
Matrix with_gaps(Matrix data, std::uint64_t seed) {
  Random random(seed);
  for (const Index length : {1, 1, 1, 1, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15}) {
    const auto joint =
        static_cast<Index>(random.below(static_cast<std::uint64_t>(data.cols() / 3)));
    const auto first =
        static_cast<Index>(random.below(static_cast<std::uint64_t>(data.rows() - 40)));
    data.block(first + 20, 3 * joint, length, 3).setConstant(nan);
  }
  return data;
}

// How many errors lie within one and two stated deviations.
struct Shares {
  double one = 0, two = 0, all = 0;

  void add(double error, double sigma) {
    one += error <= sigma;
    two += error <= 2 * sigma;
    ++all;
  }

  void expect_calibrated() const {
    EXPECT_GE(one / all, 0.6);
    EXPECT_LE(one / all, 0.75);
    EXPECT_GE(two / all, 0.92);
    EXPECT_LE(two / all, 0.98);
  }
};

class MatrixNormalContract : public testing::TestWithParam<BackendKind> {
 protected:
  std::unique_ptr<Backend> backend_ = test::make_backend(GetParam());
};

TEST_P(MatrixNormalContract, ResultsDoNotDependOnPackingOrNeighbours) {
  const SegmentBatch data = batch_of({50, 2, 12, 90}, 21);
  const std::vector<MotionPrior> priors = priors_of(data);
  const Solution together = backend_->solve({data, priors}, MatrixNormal{});

  for (Index b = 0; b < data.segments(); ++b) {
    const SegmentBatch own = test::batch_of({Matrix(data.segment(b))});
    const std::span prior(&priors[static_cast<std::size_t>(b)], 1);
    const Solution alone = backend_->solve({own, prior}, MatrixNormal{});
    EXPECT_TRUE(
        test::same_bits(Matrix(together.low_rank.segment(b)), Matrix(alone.low_rank.segment(0))));
    EXPECT_TRUE(test::same_bits(Matrix(together.deviation->segment(b)),
                                Matrix(alone.deviation->segment(0))));
  }
}

TEST_P(MatrixNormalContract, RefusesPriorsThatAreNotOnePerSegmentOrThatAMethodDoesNotTake) {
  const SegmentBatch data = batch_of({50, 60}, 9);
  const std::vector<MotionPrior> priors = priors_of(data);

  EXPECT_THROW(backend_->solve({data, std::span(priors).first(1)}, MatrixNormal{}), ArgumentError);
  EXPECT_THROW(backend_->solve({data, priors}, TruncatedSvd{}), ArgumentError);
}

TEST_P(MatrixNormalContract, TellsWhatItRejected) {
  const SegmentBatch data = batch_of({80}, 21);

  const Solution s = backend_->solve(data, MatrixNormal{});

  const Matrix d = data.segment(0), motion = s.low_rank.segment(0);
  EXPECT_TRUE(motion.allFinite());
  for (Index i = 0; i < d.rows(); ++i)
    for (Index j = 0; j < d.cols(); ++j) {
      const bool gross = !std::isnan(d(i, j)) && s.trusted->segment(0)(i, j) == 0;
      EXPECT_EQ(s.sparse.segment(0)(i, j), gross ? d(i, j) - motion(i, j) : 0);
      EXPECT_GT(s.deviation->segment(0)(i, j), 0);
    }
}

// Of samples in use under noise, and of gaps of one and of 15 frames without: in gaps under dense
// noise sigma is too small (docs/decisions/sigma.md).
TEST_P(MatrixNormalContract, SigmaIsCalibratedOnMotionOfTheModel) {
  for (const double noise : {0., 1., 30.}) {
    SCOPED_TRACE("noise " + std::to_string(noise));
    Shares used, filled;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const Matrix motion = test::model_motion(400, 21, seed).motion;
      const Matrix data = with_gaps(motion + noise * test::random_matrix(400, 21, seed + 9), seed);
      const Solution s = backend_->solve(test::batch_of({data}), MatrixNormal{});
      const Matrix error = (s.low_rank.segment(0) - motion).cwiseAbs();
      const Matrix sigma = s.deviation->segment(0);
      for (Index i = 0; i < data.rows(); ++i)
        for (Index j = 0; j < data.cols(); ++j)
          (std::isnan(data(i, j)) ? filled : used).add(error(i, j), sigma(i, j));
    }
    (noise > 0 ? used : filled).expect_calibrated();
  }
}

TEST_P(MatrixNormalContract, KeepsThePaddingZero) {
  const Solution s = backend_->solve(batch_of({40, 30}, 21), MatrixNormal{});

  for (const SegmentBatch* part : {&s.low_rank, &s.sparse, &*s.trusted, &*s.deviation}) {
    const Eigen::Map<const Matrix> rows(part->storage().data(), part->rows(), part->pitch());
    EXPECT_EQ(rows.rightCols(part->pitch() - part->columns()).cwiseAbs().sum(), 0);
  }
}

TEST_P(MatrixNormalContract, ReportsEverySegmentAndStopsWhenAsked) {
  Progress last;
  std::stop_source stop;
  const SegmentBatch data = batch_of({40, 30}, 9);
  backend_->solve(data, MatrixNormal{}, {.report = [&](const Progress& p) { last = p; }});
  stop.request_stop();

  EXPECT_EQ(last.finished, 2);
  EXPECT_EQ(last.total, 2);
  EXPECT_THROW(backend_->solve(data, MatrixNormal{}, {.stop = stop.get_token()}), Cancelled);
}

INSTANTIATE_TEST_SUITE_P(Backends, MatrixNormalContract,
                         testing::Values(BackendKind::reference, BackendKind::opencl_cpu,
                                         BackendKind::opencl_clblast, BackendKind::opencl_gpu128),
                         [](const auto& parameter) { return to_string(parameter.param); });

using test::Shape;

void expect_agreement(const std::vector<Index>& lengths, Index columns, const MatrixNormal& method,
                      BackendKind kind) {
  const SegmentBatch data = batch_of(lengths, columns);
  const std::vector<MotionPrior> priors =
      columns % 3 == 0 ? priors_of(data) : std::vector<MotionPrior>{};
  const Problem problem(data, priors);

  const Solution device = test::make_backend(kind)->solve(problem, method);
  const Solution reference = ReferenceBackend(2).solve(problem, method);

  for (Index b = 0; b < data.segments(); ++b) {
    SCOPED_TRACE("segment " + std::to_string(b));
    const auto i = static_cast<std::size_t>(b);
    const auto known = [](const auto& m) { return m.array().isNaN().select(0, m).eval(); };
    EXPECT_EQ(device.segments[i].iterations, reference.segments[i].iterations);
    EXPECT_EQ(Matrix(device.trusted->segment(b)), Matrix(reference.trusted->segment(b)));
    EXPECT_LE(test::relative_difference(known(Matrix(device.low_rank.segment(b))),
                                        known(Matrix(reference.low_rank.segment(b)))),
              test::tolerance::backends_smoothing());
    EXPECT_LE(test::relative_difference(known(Matrix(device.deviation->segment(b))),
                                        known(Matrix(reference.deviation->segment(b)))),
              test::tolerance::backends_smoothing());
  }
}

class MatrixNormalAgreement : public testing::TestWithParam<std::tuple<BackendKind, Shape>> {};

TEST_P(MatrixNormalAgreement, OfDeviceAndReference) {
  const auto& [kind, shape] = GetParam();
  expect_agreement({shape.rows, shape.rows + 1}, shape.columns, {}, kind);
}

// All kernels, in so few steps that Oclgrind, which interprets them, is soon done.
class MatrixNormalFirstSteps : public testing::TestWithParam<BackendKind> {};

TEST_P(MatrixNormalFirstSteps, AgreeOnATinyProblem) {
  expect_agreement({5, 6}, 6, {.soft_steps = 1, .hard_steps = 1, .solve_iterations = 2},
                   GetParam());
}

INSTANTIATE_TEST_SUITE_P(Forms, MatrixNormalFirstSteps,
                         testing::Values(BackendKind::opencl_cpu, BackendKind::opencl_gpu64),
                         [](const auto& parameter) { return to_string(parameter.param); });

std::string name_of_matrix_normal(
    const testing::TestParamInfo<MatrixNormalAgreement::ParamType>& parameter) {
  const auto& [kind, shape] = parameter.param;
  return to_string(kind) + "_" + std::to_string(shape.rows) + "x" + std::to_string(shape.columns);
}

INSTANTIATE_TEST_SUITE_P(Shapes, MatrixNormalAgreement,
                         testing::Combine(testing::Values(BackendKind::opencl_cpu),
                                          testing::Values(Shape{1, 1}, Shape{3, 5}, Shape{9, 6},
                                                          Shape{64, 64}, Shape{200, 93},
                                                          Shape{61, 129}, Shape{25, 93},
                                                          Shape{300, 9}, Shape{530, 12})),
                         name_of_matrix_normal);

INSTANTIATE_TEST_SUITE_P(WorkGroups, MatrixNormalAgreement,
                         testing::Combine(testing::Values(BackendKind::opencl_gpu64,
                                                          BackendKind::opencl_gpu128,
                                                          BackendKind::opencl_gpu256),
                                          testing::Values(Shape{1, 1}, Shape{3, 5}, Shape{9, 6},
                                                          Shape{25, 33}, Shape{530, 12})),
                         name_of_matrix_normal);

TEST(MatrixNormalDevice, WorkGroupsOfProductsLeaveEveryBit) {
  const SegmentBatch data = batch_of({50, 12, 290}, 21);
  const auto solve = [&](BackendKind kind) {
    return test::make_backend(kind)->solve(data, MatrixNormal{.soft_steps = 2, .hard_steps = 1});
  };
  const Solution expected = solve(BackendKind::opencl_gpu256);

  for (const BackendKind kind : {BackendKind::opencl_gpu64, BackendKind::opencl_gpu128})
    EXPECT_TRUE(test::same_bits(solve(kind).low_rank, expected.low_rank)) << to_string(kind);
}

TEST(MatrixNormalDevice, IsCutToTheMemoryLimitWithoutChangingABit) {
  const SegmentBatch data = batch_of({50, 12, 33, 90}, 21);
  OpenClBackend whole(test::device()), small(test::device(), {.memory_limit = 600 * 1024});

  EXPECT_TRUE(test::same_bits(small.solve(data, MatrixNormal{}).low_rank,
                              whole.solve(data, MatrixNormal{}).low_rank));
}

TEST(MatrixNormalDevice, ThreadsOfTheHostLeaveEveryBit) {
  const SegmentBatch data = batch_of({50, 4, 33, 90, 12}, 21);
  OpenClBackend alone(test::device()), together(test::device(), {.jobs = 3});
  const Solution expected = alone.solve(data, MatrixNormal{});

  const Solution solution = together.solve(data, MatrixNormal{});

  EXPECT_TRUE(test::same_bits(solution.low_rank, expected.low_rank));
  EXPECT_TRUE(test::same_bits(*solution.deviation, *expected.deviation));
  EXPECT_TRUE(test::same_bits(*solution.trusted, *expected.trusted));
}

}  // namespace
}  // namespace moclean
