// The products in single precision, against those in double of the same numbers.
#include <limits>
#include <tuple>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "moclean/linalg/memory_layout.hpp"
#include "moclean/linalg/products.hpp"

#include "support/device.hpp"
#include "support/matrix.hpp"

namespace moclean {
namespace {

struct FloatWay {
  const char* name;
  Tuning tuning;
};

class FloatProducts : public testing::TestWithParam<std::tuple<FloatWay, std::pair<Index, Index>>> {
};

// All five products of a batch of three segments, from the same floats whatever Real is.
template <class Real>
std::vector<std::vector<double>> products_of(const Batch& batch, const SegmentBatch& data,
                                             const Tuning& tuning) {
  const Device& device = test::device();
  const auto upload = [&](std::span<const double> numbers) {
    std::vector<Real> values;
    for (const double number : numbers)
      values.push_back(static_cast<Real>(static_cast<float>(number)));
    return Buffer<Real>(device, std::span<const Real>(values));
  };
  MemoryLayout layout(device, batch);
  const auto zeros = [&] { return layout.square<Real>(Initially::zero); };
  std::vector<double> square(batch.square_size(), 0), weights(batch.vector_size(), 0);
  std::vector<std::int32_t> counts;
  for (Index b = 0; b < batch.segments(); ++b) {
    const SegmentRecord& segment = batch.segment(b);
    const Matrix random = test::random_matrix(segment.order, segment.order, 7);
    for (Index i = 0; i < segment.order; ++i)
      for (Index j = 0; j < segment.order; ++j)
        square[static_cast<std::size_t>(segment.square + i * segment.order_pitch + j)] =
            random(i, j);
    counts.push_back(segment.order / 2 + 1);
    for (int k = 0; k < counts.back(); ++k)
      weights[static_cast<std::size_t>(segment.vector + k)] = 1.0 / (k + 1);
  }
  const Buffer<Real> x = upload(data.storage()), z = upload(square), f = upload(weights);
  const Buffer<std::int32_t> terms(device, std::span<const std::int32_t>(counts));
  Buffer<Real> g = zeros(), w = zeros(), c = zeros();
  Buffer<Real> a = layout.stacked<Real>(Initially::zero), b = layout.stacked<Real>(Initially::zero);

  Products<Real> products(device, tuning);
  products.gram(batch, x, g);
  products.reconstruct(batch, z, f, terms, w);
  products.apply(batch, x, w, a);
  products.rotate(batch, x, z, b);
  products.compose(batch, w, z, c);

  std::vector<std::vector<double>> results;
  for (const auto* buffer : {&g, &w, &a, &b, &c}) {
    std::vector<Real> values(buffer->size());
    buffer->read(values);
    results.emplace_back(values.begin(), values.end());
  }
  // Of a Gram matrix at least the upper triangle is written.
  for (Index s = 0; s < batch.segments(); ++s) {
    const SegmentRecord& segment = batch.segment(s);
    for (Index i = 1; i < segment.order; ++i)
      for (Index j = 0; j < i; ++j)
        results[0][static_cast<std::size_t>(segment.square + i * segment.order_pitch + j)] = 0;
  }
  return results;
}

TEST_P(FloatProducts, AreThoseOfDoubleToSinglePrecision) {
  const auto& [way, shape] = GetParam();
  const auto [rows, columns] = shape;
  const SegmentBatch data = test::batch_of({test::random_matrix(rows * 3 / 2 + 1, columns, 1),
                                            test::random_matrix(rows, columns, 2),
                                            test::random_matrix(rows / 3 + 1, columns, 3)});
  const Batch batch(test::device(), data, 0, 3);

  const auto floats = products_of<float>(batch, data, way.tuning);
  const auto doubles = products_of<double>(batch, data, way.tuning);

  const char* const names[] = {"gram", "reconstruct", "apply", "rotate", "compose"};
  for (std::size_t p = 0; p < floats.size(); ++p) {
    const auto size = static_cast<Index>(floats[p].size());
    const Eigen::Map<const Eigen::VectorXd> f(floats[p].data(), size), d(doubles[p].data(), size);
    EXPECT_LE((f - d).norm(), 8 * std::numeric_limits<float>::epsilon() * d.norm()) << names[p];
  }
}

std::string name_of_float_products(
    const testing::TestParamInfo<FloatProducts::ParamType>& parameter) {
  const auto& [way, shape] = parameter.param;
  return fmt::format("{}_{}x{}", way.name, shape.first, shape.second);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, FloatProducts,
    testing::Combine(testing::Values(FloatWay{"own", {}},
                                     FloatWay{"GroupWG64",
                                              {.form = KernelForm::gpu, .work_group = 64}},
                                     FloatWay{"clblast", {.products = ProductPath::clblast}}),
                     testing::Values(std::pair<Index, Index>{3, 5}, std::pair<Index, Index>{17, 1},
                                     std::pair<Index, Index>{300, 93})),
    name_of_float_products);

}  // namespace
}  // namespace moclean
