#include "moclean/device/kernel.hpp"

#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/device.hpp"

namespace moclean {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// The prelude asks for these; the kernels here do not use them.
const Defines defines = {{"REAL", "double"}, {"VW", "1"}, {"BLOCK_ROWS", "32"}};

constexpr const char* add_source = R"(#line 1 "add.cl"
kernel void add(global const int* a, int count, int summand, global int* sum) {
  const int i = get_global_id(0);
  if (i < count) sum[i] = a[i] + summand;
}
)";

TEST(Kernel, RunsOverGridsThatAreNoMultipleOfTheWorkGroup) {
  const Device& device = test::device();
  std::vector<int> values(37), sums(37);
  std::iota(values.begin(), values.end(), 0);
  const Buffer<int> a(device, std::span<const int>(values));
  Buffer<int> sum(device, values.size());
  Kernel add(Program(device, add_source, defines), "add");

  add(Grid{.x = 37, .group_x = 8}, a, 37, 5, sum);
  sum.read(sums);

  for (int i = 0; i < 37; ++i) EXPECT_EQ(sums[static_cast<std::size_t>(i)], i + 5);
}

TEST(Kernel, PassesLocalMemoryAsAnArgument) {
  const Device& device = test::device();
  constexpr const char* reverse_source = R"(
kernel void reverse(global int* a, local int* group) {
  const int i = get_local_id(0), last = get_local_size(0) - 1;
  group[i] = a[get_global_id(0)];
  barrier(CLK_LOCAL_MEM_FENCE);
  a[get_global_id(0)] = group[last - i];
}
)";
  const std::vector<int> values = {1, 2, 3, 4, 5, 6};
  std::vector<int> reversed(values.size());
  Buffer<int> a(device, std::span<const int>(values));
  Kernel reverse(Program(device, reverse_source, defines), "reverse");

  reverse(Grid{.x = 6, .group_x = 3}, a, LocalMemory<int>{3});
  a.read(reversed);

  EXPECT_THAT(reversed, testing::ElementsAre(3, 2, 1, 6, 5, 4));
  EXPECT_GE(reverse.largest_group(), 3u);
}

TEST(Kernel, EmptyGridIsNoLaunch) {
  const Device& device = test::device();
  Buffer<int> buffer(device, 0);
  Kernel add(Program(device, add_source, defines), "add");

  EXPECT_NO_THROW(add(Grid{.x = 0}, buffer, 0, 5, buffer));
}

TEST(Program, ReportsFileAndLineOfTheKernelThatDoesNotCompile) {
  const std::string broken =
      "#line 1 \"broken.cl\"\n\nkernel void f(global int* x) { *x = undeclared; }\n";

  try {
    Kernel(Program(test::device(), broken, defines), "f");
    FAIL() << "compiled";
  } catch (const DeviceError& error) {
    // NVIDIA's compiler knows no #line; it shows the line itself.
    const auto place = testing::AnyOf(HasSubstr("broken.cl:2"), HasSubstr("*x = undeclared;"));
    EXPECT_THAT(error.what(), AllOf(place, HasSubstr("-DREAL=double")));
  }
}

TEST(Program, SaysWhichDefineIsMissing) {
  try {
    const Program program(test::device(), add_source, {{"REAL", "double"}});
    FAIL() << "compiled";
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(), HasSubstr("VW is not defined"));
  }
}

TEST(Kernel, RejectsAnUnknownName) {
  const Program program(test::device(), add_source, defines);

  EXPECT_THROW(Kernel(program, "subtract"), DeviceError);
}

TEST(Buffer, ReturnsWhatWasWrittenAtAnOffset) {
  Buffer<double> buffer(test::device(), 10);
  buffer.fill_zero();
  std::vector<double> values(10);

  buffer.write(std::vector<double>{1.5, -2.5}, 7);
  buffer.read(values);

  EXPECT_THAT(values, testing::ElementsAre(0, 0, 0, 0, 0, 0, 0, 1.5, -2.5, 0));
}

TEST(Buffer, TooLargeForTheDeviceIsAnErrorThatNamesTheSize) {
  const std::uint64_t bytes = test::device().info().global_memory * 64;

  try {
    Buffer<char> buffer(test::device(), bytes);
    FAIL() << "allocated";
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(), HasSubstr(std::to_string(bytes)));
  }
}

}  // namespace
}  // namespace moclean
