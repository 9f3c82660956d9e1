#include "cli/backend/tuning_cache.hpp"

#include <cstdlib>

#include <gmock/gmock.h>

#include "cli/program.hpp"

namespace moclean::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

DeviceInfo made_up_device() {
  DeviceInfo info;
  info.name = "pthread-skylake/AMD";
  info.platform_name = "pocl";
  info.driver = "3.1";
  return info;
}

const DeviceInfo device = made_up_device();
const Tuning tuning{.tile_rows = 6,
                    .tile_vectors = 4,
                    .sweep_rows = 48,
                    .panel = 2,
                    .form = KernelForm::gpu,
                    .products = ProductPath::clblast,
                    .work_group = 32,
                    .eigen = KernelForm::gpu,
                    .batch_segments = 64,
                    .queues = 3};

class TuningCache : public ::testing::Test {
 protected:
  // The file with one piece of its text replaced.
  CachedTuning read_changed(const std::string& from, const std::string& to) const {
    write_tuning(file_, device, tuning);
    std::string text = test::content(file_);
    const auto place = text.find(from);
    EXPECT_NE(place, text.npos) << from;
    folder_.write_text("tuning.json", text.replace(place, from.size(), to));
    return read_tuning(file_, device);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "tuning.json";
};

TEST_F(TuningCache, ReturnsWhatWasWritten) {
  const std::filesystem::path file = folder_ / "a/b/tuning.json";

  write_tuning(file, device, tuning);
  const CachedTuning cached = read_tuning(file, device);

  EXPECT_EQ(cached.tuning, tuning);
  EXPECT_THAT(cached.problem, IsEmpty());
}

TEST_F(TuningCache, FileThatIsNotThereIsNoProblem) {
  const CachedTuning cached = read_tuning(file_, device);

  EXPECT_FALSE(cached.tuning);
  EXPECT_THAT(cached.problem, IsEmpty());
}

TEST_F(TuningCache, DamagedFileIsAProblemThatNamesIt) {
  for (const char* text : {"", "{", "[]", "\xff\xfe", "{\"format\": 7}", "null"}) {
    folder_.write_text("tuning.json", text);

    const CachedTuning cached = read_tuning(file_, device);

    EXPECT_FALSE(cached.tuning) << text;
    EXPECT_THAT(cached.problem, StartsWith(file_.string()));
  }
}

TEST_F(TuningCache, ForeignFileIsAProblemThatSaysWhose) {
  EXPECT_THAT(read_changed("\"3.1\"", "\"3.2\"").problem, HasSubstr("made for driver \"3.2\""));
  EXPECT_THAT(read_changed("pthread-", "opencl-").problem, HasSubstr("made for device"));
  EXPECT_THAT(read_changed("\"pocl\"", "\"nvidia\"").problem, HasSubstr("made for platform"));
  EXPECT_THAT(read_changed("\"version\": 1", "\"version\": 2").problem, HasSubstr("version 1"));
}

TEST_F(TuningCache, ChoiceOutOfItsRangeIsAProblem) {
  const std::pair<const char*, const char*> changes[] = {
      {"\"tile_rows\": 6", "\"tile_rows\": 17"},
      {"\"panel\": 2", "\"panel\": 0"},
      {"\"tile_rows\": 6", "\"tile_rows\": 1e30"},
      {"\"panel\": 2", "\"panels\": 2"},
      {"\"sweep_rows\": 48", "\"sweep_rows\": \"\""},
      {"\"eigen\": \"gpu\"", "\"eigen\": \"grape\""},
      {"\"clblast\"", "\"blas\""},
      {"\"clblast\"", "\"group\""},
      {"\"form\": \"gpu\"", "\"form\": \"group\""},
      {"\"work_group\": 32", "\"work_group\": 8"},
      {": 64", ": 4294967297"},
      {"\"queues\": 3", "\"queues\": 0"},
      {"\"queues\": 3", "\"queues\": 65"}};
  for (const auto& [from, to] : changes) {
    const CachedTuning cached = read_changed(from, to);

    EXPECT_FALSE(cached.tuning) << to;
    EXPECT_THAT(cached.problem, StartsWith(file_.string())) << to;
  }
}

TEST_F(TuningCache, FileFromBeforeThereWereQueuesTakesTheirDefault) {
  const CachedTuning cached = read_changed(",\n    \"queues\": 3", "");

  ASSERT_TRUE(cached.tuning) << cached.problem;
  Tuning expected = tuning;
  expected.queues = default_tuning(device).queues;
  EXPECT_EQ(cached.tuning, expected);
}

TEST_F(TuningCache, FileFromBeforeThereWereWorkGroupsTakesTheirDefault) {
  const CachedTuning cached = read_changed("    \"work_group\": 32,\n", "");

  ASSERT_TRUE(cached.tuning) << cached.problem;
  EXPECT_EQ(cached.tuning->work_group, Tuning{}.work_group);
}

TEST_F(TuningCache, FileFromBeforeFormsHadANameTellsThemByItsProducts) {
  const std::string here = "    \"form\": \"gpu\",\n    \"products\": \"clblast\"";
  const CachedTuning group = read_changed(here, "    \"products\": \"group\"");
  const CachedTuning own = read_changed(here, "    \"products\": \"own\"");
  const CachedTuning clblast = read_changed(here, "    \"products\": \"clblast\"");

  ASSERT_TRUE(group.tuning) << group.problem;
  EXPECT_EQ(group.tuning->form, KernelForm::gpu);
  EXPECT_EQ(group.tuning->products, ProductPath::own);
  ASSERT_TRUE(own.tuning && clblast.tuning) << own.problem << clblast.problem;
  EXPECT_EQ(own.tuning->form, KernelForm::cpu);
  EXPECT_EQ(own.tuning->products, ProductPath::own);
  EXPECT_EQ(clblast.tuning->form, KernelForm::cpu);
  EXPECT_EQ(clblast.tuning->products, ProductPath::clblast);
}

TEST_F(TuningCache, FileFromBeforeFormsHadANameTellsThatOfTheEigensolver) {
  const CachedTuning group = read_changed("\"eigen\": \"gpu\"", "\"eigen\": \"group\"");
  const CachedTuning lanes = read_changed("\"eigen\": \"gpu\"", "\"eigen\": \"lanes\"");

  ASSERT_TRUE(group.tuning && lanes.tuning) << group.problem << lanes.problem;
  EXPECT_EQ(group.tuning->eigen, KernelForm::gpu);
  EXPECT_EQ(lanes.tuning->eigen, KernelForm::cpu);
}

TEST_F(TuningCache, LiesInTheCacheDirectoryOfTheUser) {
  setenv("XDG_CACHE_HOME", "/cache", 1);
  const auto by_xdg = tuning_file(device);
  setenv("XDG_CACHE_HOME", "relative", 1);
  setenv("HOME", "/home/kim", 1);
  const auto relative = tuning_file(device);
  unsetenv("XDG_CACHE_HOME");
  const auto by_home = tuning_file(device);
  unsetenv("HOME");
  const auto nowhere = tuning_file(device);

  EXPECT_THAT(by_xdg.string(), StartsWith("/cache/moclean/tuning-pthread-skylake-AMD-"));
  EXPECT_EQ(by_home, "/home/kim/.cache/moclean" / by_xdg.filename());
  EXPECT_EQ(relative, by_home);
  EXPECT_TRUE(nowhere.empty());
}

TEST_F(TuningCache, EveryDriverHasAFileOfItsOwn) {
  setenv("XDG_CACHE_HOME", "/cache", 1);
  DeviceInfo newer = device;
  newer.driver = "4.0";

  EXPECT_NE(tuning_file(newer), tuning_file(device));
}

}  // namespace
}  // namespace moclean::cli
