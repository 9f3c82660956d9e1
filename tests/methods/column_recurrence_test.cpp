// The recurrences over the rows of a column, kernels/matrix_normal/conjugate_gradients.cl and
// kernels/linalg/banded.cl: in the vectors of this device, and with one real to a vector, as on a
// GPU, where several rows are loaded at a time.
#include <numeric>

#include <gtest/gtest.h>

#include "moclean/device/kernel_source.hpp"
#include "moclean/linalg/batch.hpp"

#include "support/band_systems.hpp"
#include "support/device.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

constexpr int order = 2;  // of the difference

// Around multiples of eight rows; no segment is wide.
std::vector<Index> lengths_of(Index columns) {
  if (columns == 1) return {1, 2, 3, 7, 8, 9, 15, 16, 17, 300};
  return {9, 15, 16, 17, 31, 300};
}

struct Form {
  bool scalar;  // vectors of one real
  Index columns;
};

std::string name_of_form(const testing::TestParamInfo<Form>& info) {
  return (info.param.scalar ? "Scalar" : "Vector") + std::to_string(info.param.columns);
}

SegmentBatch random_batch(Index columns, std::uint64_t seed, bool positive = false) {
  std::vector<Matrix> segments;
  for (const Index length : lengths_of(columns)) {
    const Matrix m = test::random_matrix(length, columns, seed++);
    segments.push_back(positive ? Matrix(m.cwiseAbs().array() + 0.1) : m);
  }
  return test::batch_of(segments);
}

class ColumnRecurrence : public testing::TestWithParam<Form> {
 protected:
  ColumnRecurrence() : batch_(device_, W_, 0, W_.segments()) {}

  int width() const { return GetParam().scalar ? 1 : vector_width(device_); }
  Defines defines() const {
    Defines defines = common_defines(device_);
    defines["VW"] = std::to_string(width());
    return defines;
  }
  Grid columns() const {  // one item too many across, which has nothing to do
    return {.x = static_cast<std::size_t>(batch_.pitch() / width() + 1),
            .y = static_cast<std::size_t>(batch_.active_count())};
  }
  template <class T>
  Buffer<T> upload(const std::vector<T>& values) const {
    return Buffer<T>(device_, std::span<const T>(values));
  }
  Buffer<double> upload(const SegmentBatch& rows) const {
    return Buffer<double>(device_, rows.storage());
  }
  SegmentBatch download(const Buffer<double>& buffer) const {
    SegmentBatch rows(W_.columns(), W_.first_rows());
    buffer.read(rows.storage());
    return rows;
  }
  // Of a segment, from what is stored per vector of columns.
  double sum_of(const Buffer<double>& per_vector, Index segment) const {
    const auto vectors = static_cast<std::size_t>(batch_.pitch() / width());
    std::vector<double> all(vectors * static_cast<std::size_t>(W_.segments()));
    per_vector.read(all);
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(vectors) * segment;
    return std::accumulate(first, first + static_cast<std::ptrdiff_t>(vectors), 0.0);
  }
  void expect_solved(const SegmentBatch& x, const SegmentBatch& b, double more) const {
    for (Index s = 0; s < b.segments(); ++s)
      for (Index j = 0; j < b.columns(); ++j) {
        const test::BandSystem system{(W_.segment(s).col(j).array() + more).matrix(),
                                      b.segment(s).col(j), penalty(j), order};
        EXPECT_LE(test::backward_error(system, x.segment(s).col(j)),
                  test::tolerance::band_backward_error(order))
            << "segment " << s << ", column " << j;
      }
  }
  // r.z of a segment, terms of at most `magnitude`.
  void expect_product(const Buffer<double>& per_vector, const SegmentBatch& r,
                      const SegmentBatch& z, Index segment, double magnitude) const {
    EXPECT_NEAR(sum_of(per_vector, segment),
                r.segment(segment).cwiseProduct(z.segment(segment)).sum(),
                test::tolerance::sum_of_products(r.rows(segment) * r.columns(), magnitude));
  }
  double penalty(Index column) const { return 20 * (1 + double(column) / double(W_.columns())); }
  std::vector<double> penalties() const {  // zero in the padding
    std::vector<double> q;
    for (Index s = 0; s < W_.segments(); ++s)
      for (Index j = 0; j < W_.pitch(); ++j) q.push_back(j < W_.columns() ? penalty(j) : 0);
    return q;
  }

  // P of the second difference that begins with a row: 1, and 0 of the last two.
  std::vector<double> precision_of_rows() const {
    std::vector<double> precisions;
    for (Index s = 0; s < W_.segments(); ++s)
      for (Index i = 0; i < W_.rows(s); ++i) precisions.push_back(i + order < W_.rows(s));
    return precisions;
  }

  const Device& device_ = test::device();
  const SegmentBatch W_ = random_batch(GetParam().columns, 1, true);
  const SegmentBatch D_ = random_batch(GetParam().columns, 20);
  const Batch batch_;
};

TEST_P(ColumnRecurrence, BandSystemsOfColumnsAreSolved) {
  Defines with_width = defines();
  with_width["WIDTH"] = std::to_string(order);
  const Program program(device_, kernel_source::banded, with_width);
  Kernel assemble(program, "assemble_columns"), factor(program, "factor_columns"),
      solve(program, "solve_columns");
  const Buffer<double> w = upload(W_), q = upload(penalties());
  Buffer<double> bands(device_, 3 * batch_.stacked_size()), x = upload(D_);
  const auto to_next_band = static_cast<cl_long>(batch_.stacked_size());

  assemble(columns(), batch_.device_segments(), batch_.device_active(), to_next_band, w, q, bands);
  factor(columns(), batch_.device_segments(), batch_.device_active(), to_next_band, bands);
  solve(columns(), batch_.device_segments(), batch_.device_active(), to_next_band, bands, x, x);

  expect_solved(download(x), D_, 0);
}

TEST_P(ColumnRecurrence, ASharedFactorSolvesAsThatOfAColumnDoes) {
  Defines with_width = defines();
  with_width["WIDTH"] = std::to_string(order);
  const Program program(device_, kernel_source::banded, with_width);
  Kernel factor(program, "factor_shared"), solve(program, "solve_shared");
  const auto segments = static_cast<std::size_t>(D_.segments());
  const std::vector<double> weights(segments, 0.7), q(segments, 30);
  const Buffer<double> b = upload(D_);
  Buffer<double> bands(device_, 3 * static_cast<std::size_t>(D_.rows())), x = upload(W_);

  factor({.x = segments}, batch_.device_segments(), batch_.device_active(), batch_.active_count(),
         upload(weights), upload(q), bands);
  solve(columns(), batch_.device_segments(), batch_.device_active(), bands, b, x);

  const SegmentBatch solution = download(x);
  for (Index s = 0; s < D_.segments(); ++s)
    for (Index j = 0; j < D_.columns(); ++j) {
      const test::BandSystem system{Eigen::VectorXd::Constant(D_.rows(s), 0.7),
                                    D_.segment(s).col(j), 30, order};
      EXPECT_LE(test::backward_error(system, solution.segment(s).col(j)),
                test::tolerance::band_backward_error(order));
    }
}

// z = M^-1 r for the r of `start`, then for that of `update`; P = 1.
TEST_P(ColumnRecurrence, PreconditionerIsSolvedForTheGradient) {
  const Program program(device_, kernel_source::conjugate_gradients, defines());
  Kernel factor(program, "factor"), start(program, "start"), update(program, "update");
  const SegmentBatch Q = random_batch(W_.columns(), 40), P = random_batch(W_.columns(), 60);
  const auto segments = static_cast<std::size_t>(W_.segments());
  const std::size_t sums = segments * static_cast<std::size_t>(batch_.pitch() / width());
  const std::vector<double> one(batch_.block_count(), 1);
  const Buffer<double> w = upload(W_), d = upload(D_), q = upload(Q), p = upload(P),
                       precisions = upload(precision_of_rows()), stiffness = upload(penalties()),
                       least = upload(std::vector<double>(segments, 0.25)), pq = upload(one);
  Buffer<double> pivots = upload(W_), band = upload(W_), S = upload(D_), r = upload(W_),
                 z = upload(W_), rz(device_, sums), bz(device_, sums), rz_next(device_, sums);

  factor(columns(), batch_.device_segments(), batch_.device_active(), w, precisions, stiffness,
         least, pivots, band);
  start(columns(), batch_.device_segments(), batch_.device_active(), d, w, precisions, stiffness,
        pivots, band, q, r, z, rz, bz);
  const SegmentBatch r0 = download(r), z0 = download(z);
  update(columns(), batch_.device_segments(), batch_.device_active(), precisions, stiffness, pivots,
         band, p, q, pq, rz, bz, cl_double{0}, S, r, z, rz_next);
  const SegmentBatch r1 = download(r), z1 = download(z), motion = download(S);

  expect_solved(z0, r0, 0.25);
  expect_solved(z1, r1, 0.25);
  for (Index s = 0; s < W_.segments(); ++s) {
    const Index blocks = (W_.rows(s) + block_rows - 1) / block_rows;
    const double alpha = sum_of(rz, s) / double(blocks);  // p.q is 1 in every block
    const Matrix gradient = W_.segment(s).cwiseProduct(D_.segment(s)) - Q.segment(s);
    const double bound = test::tolerance::by_hand(8 * (1 + alpha));
    EXPECT_LE((r0.segment(s) - gradient).cwiseAbs().maxCoeff(), bound);
    EXPECT_LE((r1.segment(s) - (r0.segment(s) - alpha * Q.segment(s))).cwiseAbs().maxCoeff(),
              bound);
    EXPECT_LE((motion.segment(s) - (D_.segment(s) + alpha * P.segment(s))).cwiseAbs().maxCoeff(),
              bound);
    expect_product(rz, r0, z0, s, 64);
    expect_product(rz_next, r1, z1, s, 64 * (1 + alpha * alpha));
  }
}

INSTANTIATE_TEST_SUITE_P(Forms, ColumnRecurrence,
                         testing::Values(Form{true, 1}, Form{true, 9}, Form{false, 1},
                                         Form{false, 9}),
                         name_of_form);

}  // namespace
}  // namespace moclean
