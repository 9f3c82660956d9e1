#include "moclean/core/large_memory.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include <gmock/gmock.h>

namespace moclean {
namespace {

template <class T>
using Vector = std::vector<T, LargeAllocator<T>>;

TEST(LargeAllocator, MakesVectorsOfAnySizeThatKeepTheirValues) {
  for (const std::size_t count : {0u, 1u, 7u, 524'287u, 524'288u, 700'001u}) {  // 4 MiB: 524288
    Vector<double> values(count);
    EXPECT_TRUE(std::ranges::all_of(values, [](double x) { return x == 0; })) << count;
    std::iota(values.begin(), values.end(), 0.5);

    values.resize(2 * count + 1);

    for (std::size_t i = 0; i < count; i += 1 + count / 100)
      EXPECT_EQ(values[i], static_cast<double>(i) + 0.5) << count;
    EXPECT_EQ(values.back(), 0) << count;
  }
}

TEST(LargeAllocator, StartsLargeArraysOnAHugePage) {
  const Vector<char> large(std::size_t{5} << 20);

  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(large.data()) % (std::size_t{1} << 21), 0u);
}

}  // namespace
}  // namespace moclean
