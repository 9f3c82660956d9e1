#include <gmock/gmock.h>

#include "moclean/device/kernel.hpp"

#include "support/device.hpp"

namespace moclean {
namespace {

using ::testing::Optional;

constexpr std::string_view source = R"(
kernel void fill(global double* x, double value) { x[get_global_id(0)] = value; }
kernel void clear(global double* x) { x[get_global_id(0)] = 0; }
)";
const Defines profiled_defines = {{"REAL", "double"}, {"VW", "1"}, {"BLOCK_ROWS", "32"}};

const Device& profiled_device() {
  static const Device* device = new Device(test::device().info().name, Profiling::on);
  return *device;
}

MATCHER_P2(IsWork, flops, bytes, "") { return arg.flops == flops && arg.bytes == bytes; }

TEST(Profile, CountsCallsTimeAndWork) {
  const Device& device = profiled_device();
  const Program program(device, source, profiled_defines);
  Kernel fill(program, "fill"), clear(program, "clear");
  Buffer<double> x(device, 64);

  for (int i = 0; i < 3; ++i)
    fill.with([] { return Work{.flops = 2, .bytes = 512}; })(Grid{.x = 64}, x, 1.0);
  clear.with([] { return Work{.flops = 1, .bytes = 1}; })(Grid{.x = 64}, x);
  clear(Grid{.x = 64}, x);
  clear(Grid{.x = 0}, x);  // no launch
  auto kernels = device.profile()->kernels();

  ASSERT_EQ(kernels.size(), 2u);
  EXPECT_GE(kernels[0].seconds, kernels[1].seconds);
  if (kernels[0].kernel != "fill") std::swap(kernels[0], kernels[1]);
  EXPECT_EQ(kernels[0].calls, 3);
  EXPECT_GT(kernels[0].seconds, 0);
  EXPECT_THAT(kernels[0].work, Optional(IsWork(6.0, 1536.0)));
  EXPECT_EQ(kernels[1].calls, 2);
  device.profile()->clear();
  EXPECT_TRUE(device.profile()->kernels().empty());
  EXPECT_FALSE(kernels[1].work) << "the work of one of its launches is not known";
}

TEST(BusyTime, CountsOverlapsOnceInAnyOrder) {
  BusyTime busy;
  EXPECT_EQ(busy.seconds(), 0);

  busy.add(30'000'000'000, 31'000'000'000);
  busy.add(10'000'000'000, 14'000'000'000);
  busy.add(12'000'000'000, 15'000'000'000);
  busy.add(13'000'000'000, 14'000'000'000);

  EXPECT_DOUBLE_EQ(busy.seconds(), 6);
  busy.add(31'000'000'000, 31'500'000'000);
  EXPECT_DOUBLE_EQ(busy.seconds(), 6.5);
}

TEST(BusyTime, StaysExactWhenMoreComesThanIsReordered) {
  BusyTime busy;
  constexpr std::uint64_t spans = 3 * BusyTime::reordered;

  for (std::uint64_t i = 0; i < spans; ++i) {
    const std::uint64_t begin = 1000 * (i ^ 1);  // neighbours swapped
    busy.add(begin, begin + 500);
  }

  EXPECT_NEAR(busy.seconds(), 500e-9 * spans, 1e-12);
}

TEST(Profile, OfAnotherQueueIsThatOfTheDevice) {
  const Device& device = profiled_device();
  const Device another(device, Device::AnotherQueue{});
  device.profile()->clear();
  Kernel here(Program(device, source, profiled_defines), "fill");
  Kernel there(Program(another, source, profiled_defines), "fill");
  Buffer<double> x(device, 64), y(another, 64);
  std::vector<double> values(64);

  here(Grid{.x = 64}, x, 1.0);
  there(Grid{.x = 64}, y, 2.0);
  y.read(values);

  EXPECT_EQ(values.front(), 2);
  EXPECT_NE(another.queue()(), device.queue()());
  EXPECT_EQ(another.profile(), device.profile());
  EXPECT_EQ(device.profile()->kernels().at(0).calls, 2);
}

TEST(Profile, IsNotThereAndAsksForNoWorkUnlessItIsOn) {
  const Program program(test::device(), source, profiled_defines);
  Kernel clear(program, "clear");
  Buffer<double> x(test::device(), 64);
  bool asked = false;

  clear.with([&] {
    asked = true;
    return Work{};
  })(Grid{.x = 64}, x);

  EXPECT_EQ(test::device().profile(), nullptr);
  EXPECT_FALSE(asked);
}

}  // namespace
}  // namespace moclean
