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
const Defines defines = {{"REAL", "double"}, {"VW", "1"}, {"BLOCK_ROWS", "32"}};

const Device& profiled_device() {
  static const Device* device = new Device(test::device().info().name, Profiling::on);
  return *device;
}

MATCHER_P2(IsWork, flops, bytes, "") { return arg.flops == flops && arg.bytes == bytes; }

TEST(Profile, CountsCallsTimeAndWork) {
  const Device& device = profiled_device();
  const Program program(device, source, defines);
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

TEST(Profile, IsNotThereAndAsksForNoWorkUnlessItIsOn) {
  const Program program(test::device(), source, defines);
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
