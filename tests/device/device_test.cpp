#include "moclean/device/device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/device.hpp"

namespace moclean {
namespace {

using testing::HasSubstr;

std::string error_of(std::string_view selection) {
  try {
    Device device(selection);
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

TEST(Device, IsFoundByIndexPairAndNameFragmentInAnyCase) {
  const DeviceInfo any = list_devices().at(0);
  std::string upper = any.name;
  for (char& c : upper) c = static_cast<char>(std::toupper(c));

  const Device by_index(std::to_string(any.platform) + ":" + std::to_string(any.index));
  const Device by_name(upper);

  EXPECT_EQ(by_index.info().name, any.name);
  EXPECT_EQ(by_name.info().name, any.name);
}

TEST(Device, IsFoundByKind) {
  for (const DeviceInfo& info : list_devices())
    if (info.kind != DeviceKind::other) {
      EXPECT_EQ(Device(to_string(info.kind)).info().kind, info.kind);
    }
}

TEST(Device, WithoutMatchNamesTheRequestAndWhatThereIs) {
  const std::string error = error_of("no-such-device");

  EXPECT_THAT(error, HasSubstr("no OpenCL device matches 'no-such-device'"));
  EXPECT_THAT(error, HasSubstr(list_devices().at(0).name));
}

TEST(Device, IndexPairIsNotTakenForAnotherDevice) {
  EXPECT_THAT(error_of("97:3"), HasSubstr("no OpenCL device matches '97:3'"));
}

TEST(Device, StatesItsLimits) {
  const DeviceInfo& info = test::device().info();

  EXPECT_GT(info.compute_units, 0);
  EXPECT_GT(info.global_memory, 0u);
  EXPECT_GE(info.global_memory, info.max_allocation);
  EXPECT_GT(info.max_work_group, 0u);
  EXPECT_FALSE(info.driver.empty());
}

}  // namespace
}  // namespace moclean
