#include "moclean/run/same_file.hpp"

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

#include "support/temporary_folder.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class SameFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.write_text("a", "");
    folder_.write_text("b", "");
    fs::create_symlink("a", folder_ / "link");
    fs::create_hard_link(folder_ / "a", folder_ / "hard");
    fs::create_symlink("new", folder_ / "to-new");
  }

  std::string key(const std::string& name) const { return file_key(folder_ / name); }

  test::TemporaryFolder folder_;
};

TEST_F(SameFile, HasOneKeyByWhateverName) {
  for (const char* name : {"link", "hard", "./a"}) EXPECT_EQ(key(name), key("a")) << name;
  EXPECT_NE(key("a"), key("b"));
}

TEST_F(SameFile, HasOneKeyBeforeItIsThere) {
  for (const char* name : {"to-new", "./new"}) EXPECT_EQ(key(name), key("new")) << name;
  EXPECT_NE(key("new"), key("newer"));
  EXPECT_NE(key("new"), "");
}

TEST_F(SameFile, IsNoneForWhatNothingReplaces) {
  EXPECT_EQ(file_key("/dev/null"), "");
  EXPECT_EQ(file_key(""), "");
  EXPECT_EQ(file_key("-"), "");
}

TEST_F(SameFile, MayNotBeReadAndWrittenOrWrittenTwice) {
  const NamedFile read[] = {{"INPUT", folder_ / "a"}, {"--config", ""}};
  const NamedFile over[] = {{"--json", folder_ / "hard"}};
  const NamedFile twice[] = {{"--json", folder_ / "new"}, {"--lines", folder_ / "to-new"}};
  const NamedFile apart[] = {
      {"--json", folder_ / "b"}, {"--lines", folder_ / "new"}, {"-o", "-"}, {"--mask", ""},
      {"--sigma", "/dev/null"},  {"--report", "/dev/null"}};

  EXPECT_THAT([&] { require_apart(read, over); },
              ThrowsMessage<ArgumentError>(HasSubstr("is the file that INPUT names")));
  EXPECT_THAT([&] { require_apart(twice); },
              ThrowsMessage<ArgumentError>(HasSubstr("--json and --lines would both write")));
  EXPECT_NO_THROW(require_apart(read, apart));
}

}  // namespace
}  // namespace moclean
