#include "cli/backend/driver_check.hpp"

#include <csignal>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "support/temporary_folder.hpp"

namespace moclean::cli {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class DriverCheck : public ::testing::Test {
 protected:
  test::TemporaryFolder folder_;  // empty: no processor is listed in it
};

TEST_F(DriverCheck, ADriverThatEndsItsProcessIsAnErrorThatSaysWhatToDo) {
  for (const std::string& cpus : {folder_ / "none", folder_ / ""})
    EXPECT_THAT([&] { require_driver(cpus, [] { std::raise(SIGABRT); }); },
                ThrowsMessage<DeviceError>(AllOf(HasSubstr("signal 6"), HasSubstr(cpus),
                                                 HasSubstr("--backend reference"),
                                                 HasSubstr("mount -t sysfs"))));
}

TEST_F(DriverCheck, ADriverThatAnswersOrFailsIsNone) {
  EXPECT_NO_THROW(require_driver(folder_ / "none", [] {}));
  EXPECT_NO_THROW(require_driver(folder_ / "none", [] { throw DeviceError("no platform"); }));
}

TEST_F(DriverCheck, IsNotAskedWhereTheProcessorsAreListed) {
  folder_.write_text("cpu0", "");

  EXPECT_NO_THROW(require_driver(folder_ / "", [] { std::raise(SIGABRT); }));
}

}  // namespace
}  // namespace moclean::cli
