// The methods beside robust PCA: what every backend promises for them, and the device against the
// reference over odd shapes.
#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/core/random.hpp"

#include "support/backends.hpp"
#include "support/matrix.hpp"
#include "support/nan.hpp"
#include "support/planted.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using test::BackendKind;
using test::nan;
using testing::HasSubstr;

enum class Kind { tsvd, svt_soft, svt_hard, svt_given, completion, tslra };

Method method_of(Kind kind) {
  using Shrink = SingularValueThresholding::Shrink;
  switch (kind) {
    case Kind::tsvd:
      return TruncatedSvd{.rank = 3};
    case Kind::svt_soft:
      return SingularValueThresholding{};
    case Kind::svt_hard:
      return SingularValueThresholding{.shrink = Shrink::hard};
    case Kind::svt_given:
      return SingularValueThresholding{.threshold = 4};
    case Kind::completion:
      return MatrixCompletion{.tolerance = 1e-2, .max_iterations = 60};
    case Kind::tslra:
      break;
  }
  return TemporalRobustPca{.rho = 1.3, .tolerance = 1e-4};
}

std::string to_string(Kind kind) {
  constexpr std::array names = {"Tsvd", "SvtSoft", "SvtHard", "SvtGiven", "Completion", "Tslra"};
  return names[static_cast<std::size_t>(kind)];
}

constexpr auto every_method = {Kind::tsvd,      Kind::svt_soft,   Kind::svt_hard,
                               Kind::svt_given, Kind::completion, Kind::tslra};

constexpr bool fills(Kind kind) { return kind == Kind::completion || kind == Kind::tslra; }

// Low rank, gross errors and a little noise everywhere.
SegmentBatch noisy_batch(const std::vector<Index>& lengths, Index columns) {
  SegmentBatch batch = test::planted_batch({.columns = columns, .rank = 2}, lengths);
  for (Index b = 0; b < batch.segments(); ++b)
    batch.segment(b) +=
        0.1 * test::random_matrix(batch.rows(b), columns, static_cast<std::uint64_t>(b) + 50);
  return batch;
}

SegmentBatch with_gaps(SegmentBatch batch) {
  Random random(7);
  for (Index b = 0; b < batch.segments(); ++b)
    for (Index i = 0; i < batch.rows(b); ++i)
      for (Index j = 0; j < batch.columns(); ++j)
        if (random.uniform() < 0.2) batch.segment(b)(i, j) = nan;
  return batch;
}

SegmentBatch data_for(Kind kind, const std::vector<Index>& lengths, Index columns) {
  const SegmentBatch batch = noisy_batch(lengths, columns);
  return fills(kind) ? with_gaps(batch) : batch;
}

class OtherMethodContract : public testing::TestWithParam<std::tuple<BackendKind, Kind>> {
 protected:
  OtherMethodContract()
      : backend_(test::make_backend(std::get<0>(GetParam()))),
        kind_(std::get<1>(GetParam())),
        method_(method_of(kind_)) {}

  SegmentBatch ragged() const { return data_for(kind_, {50, 12, 33, 90}, 21); }
  Solution solve(const SegmentBatch& data) { return backend_->solve(data, method_); }

  // Of D - A - E: rounding, or what the method stops at.
  double sum_bound(const Matrix& data) const {
    const auto* method = std::get_if<TemporalRobustPca>(&method_);
    return method ? method->tolerance * data.array().isNaN().select(0, data).norm()
                  : test::tolerance::by_hand(30);
  }

  std::unique_ptr<Backend> backend_;
  Kind kind_;
  Method method_;
};

TEST_P(OtherMethodContract, SumOfThePartsIsTheDataWhereItWasObserved) {
  const SegmentBatch data = ragged();

  const Solution s = solve(data);

  for (Index b = 0; b < data.segments(); ++b) {
    const Matrix d = data.segment(b), sum = s.low_rank.segment(b) + s.sparse.segment(b);
    EXPECT_TRUE(sum.allFinite());
    for (Index i = 0; i < d.size(); ++i)
      if (std::isnan(d.data()[i])) {
        EXPECT_EQ(s.sparse.segment(b)(i / d.cols(), i % d.cols()), 0);
      } else {
        EXPECT_NEAR(sum.data()[i], d.data()[i], sum_bound(d));
      }
  }
}

TEST_P(OtherMethodContract, ResultsDoNotDependOnPackingOrNeighbours) {
  const SegmentBatch data = ragged();
  const Solution together = solve(data);

  for (Index b = 0; b < data.segments(); ++b) {
    const Solution alone = solve(test::batch_of({Matrix(data.segment(b))}));
    EXPECT_TRUE(
        test::same_bits(Matrix(together.low_rank.segment(b)), Matrix(alone.low_rank.segment(0))));
    EXPECT_TRUE(
        test::same_bits(Matrix(together.sparse.segment(b)), Matrix(alone.sparse.segment(0))));
  }
}

TEST_P(OtherMethodContract, KeepsThePaddingZero) {
  const Solution s = solve(ragged());

  for (const SegmentBatch* part : {&s.low_rank, &s.sparse}) {
    const Eigen::Map<const Matrix> rows(part->storage().data(), part->rows(), part->pitch());
    EXPECT_EQ(rows.rightCols(part->pitch() - part->columns()).cwiseAbs().sum(), 0);
  }
}

TEST_P(OtherMethodContract, ZeroSegmentIsSolvedWithoutAnIteration) {
  const Solution s = solve(test::batch_of({Matrix::Zero(7, 21), test::random_matrix(30, 21, 1)}));

  EXPECT_EQ(s.segments[0].iterations, 0);
  EXPECT_EQ(s.segments[0].rank, 0);
  EXPECT_TRUE(s.segments[0].converged);
  EXPECT_EQ(s.low_rank.segment(0).norm(), 0);
  EXPECT_EQ(s.sparse.segment(0).norm(), 0);
  EXPECT_GT(s.segments[1].iterations, 0);
}

TEST_P(OtherMethodContract, TakesNaNOnlyWhereItSaysSo) {
  SegmentBatch data = noisy_batch({20, 30}, 21);
  data.segment(1)(4, 20) = nan;

  if (accepts_missing(method_)) {
    EXPECT_NO_THROW(solve(data));
    return;
  }
  EXPECT_THAT([&] { solve(data); },
              testing::ThrowsMessage<ShapeError>(HasSubstr("segment 1: not finite at row 4")));
}

TEST_P(OtherMethodContract, RefusesInfinity) {
  SegmentBatch data = ragged();
  data.segment(1)(4, 20) = std::numeric_limits<double>::infinity();

  EXPECT_THROW(solve(data), ShapeError);
}

TEST_P(OtherMethodContract, ReportsEverySegmentAndStopsWhenAsked) {
  Progress last;
  std::stop_source stop;
  backend_->solve(ragged(), method_, {.report = [&](const Progress& p) { last = p; }, .stop = {}});
  stop.request_stop();

  EXPECT_EQ(last.finished, 4);
  EXPECT_EQ(last.total, 4);
  EXPECT_THROW(backend_->solve(ragged(), method_, {.report = {}, .stop = stop.get_token()}),
               Cancelled);
}

INSTANTIATE_TEST_SUITE_P(
    Backends, OtherMethodContract,
    testing::Combine(testing::Values(BackendKind::reference, BackendKind::reference_two_jobs,
                                     BackendKind::opencl_cpu, BackendKind::opencl_clblast,
                                     BackendKind::opencl_gpu128),
                     testing::ValuesIn(every_method)),
    [](const auto& parameter) {
      return to_string(std::get<0>(parameter.param)) + "_" +
             to_string(std::get<1>(parameter.param));
    });

using test::Shape;

void expect_agreement(const SegmentBatch& data, const Method& method, BackendKind backend) {
  const Solution device = test::make_backend(backend)->solve(data, method);
  const Solution reference = ReferenceBackend(2).solve(data, method);

  for (Index b = 0; b < data.segments(); ++b) {
    SCOPED_TRACE("segment " + std::to_string(b));
    const auto i = static_cast<std::size_t>(b);
    EXPECT_EQ(device.segments[i].iterations, reference.segments[i].iterations);
    EXPECT_EQ(device.segments[i].rank, reference.segments[i].rank);
    EXPECT_EQ(device.segments[i].converged, reference.segments[i].converged);
    EXPECT_NEAR(device.segments[i].residual, reference.segments[i].residual,
                test::tolerance::backends_low_rank());
    EXPECT_LE(test::relative_difference(device.low_rank.segment(b), reference.low_rank.segment(b)),
              test::tolerance::backends_low_rank());
    EXPECT_LE((device.sparse.segment(b) - reference.sparse.segment(b)).norm(),
              test::tolerance::backends_low_rank() * reference.low_rank.segment(b).norm() +
                  test::tolerance::by_hand(30));
  }
}

class OtherMethodAgreement : public testing::TestWithParam<std::tuple<BackendKind, Kind, Shape>> {};

TEST_P(OtherMethodAgreement, OnOddShapes) {
  const auto& [backend, kind, shape] = GetParam();
  const bool by_rule = kind == Kind::svt_soft || kind == Kind::svt_hard;
  if (by_rule && std::min(shape.rows, shape.columns) < 3) GTEST_SKIP() << "no rule";

  expect_agreement(data_for(kind, {shape.rows, shape.rows + 1, shape.rows}, shape.columns),
                   method_of(kind), backend);
}

// All kernels, in so few steps that Oclgrind, which interprets them, is soon done.
class OtherMethodFirstIterations : public testing::TestWithParam<BackendKind> {};

TEST_P(OtherMethodFirstIterations, AgreeOnATinyProblem) {
  const SegmentBatch data = data_for(Kind::completion, {3, 4}, 5);
  for (const Method& method : {Method(MatrixCompletion{.max_iterations = 2}),
                               Method(TemporalRobustPca{.max_iterations = 2})})
    expect_agreement(data, method, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Forms, OtherMethodFirstIterations,
                         testing::Values(BackendKind::opencl_cpu, BackendKind::opencl_gpu64),
                         [](const auto& parameter) { return to_string(parameter.param); });

std::string name_of_other_method(
    const testing::TestParamInfo<OtherMethodAgreement::ParamType>& parameter) {
  const auto& [backend, kind, shape] = parameter.param;
  return to_string(backend) + "_" + to_string(kind) + "_" + std::to_string(shape.rows) + "x" +
         std::to_string(shape.columns);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, OtherMethodAgreement,
    testing::Combine(testing::Values(BackendKind::opencl_cpu, BackendKind::opencl_clblast),
                     testing::ValuesIn(every_method),
                     testing::Values(Shape{1, 1}, Shape{3, 5}, Shape{64, 64}, Shape{200, 93},
                                     Shape{61, 129}, Shape{25, 93}, Shape{300, 9}, Shape{1, 93})),
    name_of_other_method);

INSTANTIATE_TEST_SUITE_P(
    WorkGroups, OtherMethodAgreement,
    testing::Combine(testing::Values(BackendKind::opencl_gpu128), testing::ValuesIn(every_method),
                     testing::Values(Shape{3, 5}, Shape{25, 93}, Shape{300, 9})),
    name_of_other_method);

// The only one of these methods whose steps over entries have a form for GPUs.
INSTANTIATE_TEST_SUITE_P(
    OtherWorkGroups, OtherMethodAgreement,
    testing::Combine(testing::Values(BackendKind::opencl_gpu64, BackendKind::opencl_gpu256),
                     testing::Values(Kind::tslra),
                     testing::Values(Shape{1, 1}, Shape{61, 129}, Shape{300, 9})),
    name_of_other_method);

TEST(OtherMethods, AgreeOnDataOfExactlyLowRank) {
  const Matrix data = test::random_matrix(80, 4, 2) * test::random_matrix(4, 30, 3);
  for (const Kind kind : {Kind::tsvd, Kind::svt_soft, Kind::svt_given}) {
    const Method method = method_of(kind);

    const Solution device = OpenClBackend(test::device()).solve(test::batch_of({data}), method);
    const Solution reference = ReferenceBackend().solve(test::batch_of({data}), method);

    EXPECT_EQ(device.segments[0].rank, reference.segments[0].rank) << to_string(kind);
    EXPECT_LE(test::relative_difference(device.low_rank.segment(0), reference.low_rank.segment(0)),
              test::tolerance::backends_low_rank());
  }
}

TEST(OtherMethods, AreCutToTheMemoryLimitWithoutChangingABit) {
  for (const Kind kind : every_method) {
    const SegmentBatch data = data_for(kind, {50, 12, 33, 90, 41, 60}, 21);
    OpenClBackend whole(test::device()), small(test::device(), {.memory_limit = 300 * 1024});

    const Solution expected = whole.solve(data, method_of(kind));
    const Solution cut = small.solve(data, method_of(kind));

    EXPECT_TRUE(test::same_bits(cut.low_rank, expected.low_rank)) << to_string(kind);
    EXPECT_TRUE(test::same_bits(cut.sparse, expected.sparse)) << to_string(kind);
  }
}

TEST(OtherMethods, RefuseMixedPrecision) {
  OpenClBackend mixed(test::device(), {.precision = Precision::mixed});

  EXPECT_THAT([&] { mixed.solve(noisy_batch({20}, 9), TruncatedSvd{}); },
              testing::ThrowsMessage<ArgumentError>("tsvd works in double precision (f64) only"));
}

}  // namespace
}  // namespace moclean
