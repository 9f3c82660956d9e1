#include "cli/backend/kernel_cache.hpp"

#include <map>
#include <string>

#include <gmock/gmock.h>

#include "cli/program.hpp"
#include "support/synthetic_walk.hpp"

namespace moclean::cli {
namespace {

using ::testing::HasSubstr;

std::string cache_of(const std::map<std::string, std::string>& variables) {
  return kernel_cache([&](const char* name) -> const char* {
           const auto found = variables.find(name);
           return found == variables.end() ? nullptr : found->second.c_str();
         })
      .string();
}

TEST(KernelCache, IsWhereTheEnvironmentPutsIt) {
  EXPECT_EQ(cache_of({{"POCL_CACHE_DIR", "/a"}, {"XDG_CACHE_HOME", "/b"}, {"HOME", "/c"}}), "/a");
  EXPECT_EQ(cache_of({{"XDG_CACHE_HOME", "/b"}, {"HOME", "/c"}}), "/b/pocl/kcache");
  EXPECT_EQ(cache_of({{"POCL_CACHE_DIR", ""}, {"HOME", "/c"}}), "/c/.cache/pocl/kcache");
  EXPECT_EQ(cache_of({}), "/tmp/pocl/kcache");
}

// PoCL has no device then, or builds no kernel, and says nothing.
TEST(KernelCache, ThatCannotBeUsedIsReplacedWithAWarning) {
  if (test::run({"devices", "--json"}).json().empty()) GTEST_SKIP() << "no OpenCL device";
  const test::TemporaryFolder folder;
  const std::string walk = folder.write("walk.npy", test::synthetic_walk(60));
  const std::string file = folder.write_text("file", "");
  const char* before = std::getenv("POCL_CACHE_DIR");
  const std::string kept = before ? before : "";

  setenv("POCL_CACHE_DIR", file.c_str(), 1);
  const test::Outcome outcome =
      test::run({"denoise", walk, "-o", folder / "clean.npy", "--method", "tsvd", "--quiet"});
  before ? setenv("POCL_CACHE_DIR", kept.c_str(), 1) : unsetenv("POCL_CACHE_DIR");

  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("no kernels can be kept in " + file));
}

}  // namespace
}  // namespace moclean::cli
