// How a process starts to use CLBlast, so each case runs in one of its own.

#include <cstdlib>
#include <latch>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "moclean/linalg/products.hpp"

#include "support/device.hpp"
#include "support/matrix.hpp"

namespace moclean {
namespace {

// Ends the process: 0 if every thread, with a queue of its own, got the Gram matrix of its segment.
[[noreturn]] void multiply_in_threads() {
  constexpr int threads = 8;
  const Device first(test::device(), Device::AnotherQueue{});
  const Matrix x = test::random_matrix(9, 5, 1);
  const SegmentBatch data = test::batch_of({x});
  std::vector<int> right(threads, 0);
  std::latch start(threads);
  const auto multiply = [&](std::size_t thread) {
    const Device device(first, Device::AnotherQueue{});
    const Batch batch(device, data, 0, 1);
    const Buffer<double> stacked(device, std::span<const double>(data.storage()));
    Buffer<double> g(device, batch.square_size());
    Products<double> products(device, {.products = ProductPath::clblast});
    start.arrive_and_wait();
    products.gram(batch, stacked, g, GramOf::all);
    std::vector<double> values(batch.square_size());
    g.read(values);
    right[thread] = std::abs(values[0] - x.col(0).squaredNorm()) < 1e-12;
  };
  {
    std::vector<std::jthread> running;
    for (std::size_t t = 0; t < threads; ++t) running.emplace_back(multiply, t);
  }
  std::_Exit(right == std::vector<int>(threads, 1) ? 0 : 1);
}

// CLBlast fills a table at its first call, without a lock: two at once read what the other moves.
TEST(ClblastStart, FirstProductsMayComeFromSeveralThreads) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(multiply_in_threads(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace moclean
