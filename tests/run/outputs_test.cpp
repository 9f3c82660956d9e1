// Where the results of many takes go.

#include "moclean/run/outputs.hpp"

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/formats.hpp"
#include "moclean/run/inputs.hpp"

#include "support/temporary_folder.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

class Outputs : public ::testing::Test {
 protected:
  // A request for the folder `in`, to `out`.
  OutputRequest request() const {
    const fs::path in = folder_ / "in";
    return {.inputs = {in},
            .files = expand_folders({in}),
            .output = folder_ / "out",
            .outliers = {},
            .report = {},
            .format = ""};
  }

  std::vector<std::string> in_folder(const std::vector<fs::path>& paths) const {
    std::vector<std::string> names;
    for (const fs::path& path : paths)
      names.push_back(path.lexically_relative(folder_ / "").string());
    return names;
  }

  void touch(const std::string& name, const std::string& text = "") const {
    folder_.write_text(name, text);
  }

  test::TemporaryFolder folder_;
};

TEST_F(Outputs, KeepPathsNamesAndFormats) {
  for (const char* name : {"in/a/Walk.BVH", "in/b/deep/run.c3d", "in/x.1.csv", "in/y.npy"})
    touch(name);

  const OutputPlan plan = plan_outputs(request());

  EXPECT_THAT(in_folder(plan.clean),
              ElementsAre("out/a/Walk.BVH", "out/b/deep/run.c3d", "out/x.1.csv", "out/y.npy"));
  EXPECT_THAT(plan.folders, ::testing::Contains(fs::path(folder_ / "out/b/deep")));
  EXPECT_EQ(plan.root, folder_ / "out");
}

TEST_F(Outputs, WhatIsNoMotionKeepsToFormatsOfAnySamples) {
  for (const char* name : {"in/a/walk.bvh", "in/run.npy"}) touch(name);
  OutputRequest asked = request();
  asked.mask = folder_ / "masks";
  asked.report = folder_ / "pages";

  const OutputPlan plan = plan_outputs(asked);

  EXPECT_THAT(in_folder(plan.masks), ElementsAre("masks/a/walk.csv", "masks/run.npy"));
  EXPECT_THAT(in_folder(plan.reports), ElementsAre("pages/a/walk.html", "pages/run.html"));
}

TEST_F(Outputs, AFormatThatCanOnlyBeReadBecomesCsvWithANote) {
  std::string read_only;
  for (const Format* format : formats())
    if (can_read(*format) && !can_write(*format)) read_only = format->extension;
  if (read_only.empty()) GTEST_SKIP() << "every format can be written";
  touch("in/walk" + read_only);

  const OutputPlan plan = plan_outputs(request());

  EXPECT_THAT(in_folder(plan.clean), ElementsAre("out/walk.csv"));
  EXPECT_THAT(plan.notes, ElementsAre(read_only + " cannot be written: 1 of such takes becomes "
                                                  ".csv"));
}

TEST_F(Outputs, AmcIsWrittenWithItsAsfBesideIt) {
  if (!is_of_format("x.amc", can_write)) GTEST_SKIP() << "AMC is not written";
  for (const char* name : {"in/s/14_06.amc", "in/s/14.asf"}) touch(name);

  const OutputPlan plan = plan_outputs(request());

  EXPECT_THAT(in_folder(plan.clean), ElementsAre("out/s/14_06.amc"));
  ASSERT_EQ(plan.copies[0].size(), 1u);
  EXPECT_EQ(plan.copies[0][0].from, folder_ / "in/s/14.asf");
  EXPECT_EQ(plan.copies[0][0].to, folder_ / "out/s/14.asf");
}

TEST_F(Outputs, TwoThatWouldBecomeOneFileAreBothNamed) {
  for (const char* name : {"in/walk.csv", "in/walk.npy"}) touch(name);
  OutputRequest asked = request();
  asked.format = "csv";

  EXPECT_THAT([&] { plan_outputs(asked); },
              ThrowsMessage<ArgumentError>(AllOf(HasSubstr("in/walk.csv"), HasSubstr("in/walk.npy"),
                                                 HasSubstr("would both become"))));
  EXPECT_EQ(plan_outputs(request()).clean.size(), 2u);
}

TEST_F(Outputs, ASingleFileForSeveralInputsIsRefused) {
  for (const char* name : {"in/a.csv", "in/b.csv"}) touch(name);
  OutputRequest asked = request();
  asked.output = folder_ / "clean.csv";

  EXPECT_THAT([&] { plan_outputs(asked); },
              ThrowsMessage<ArgumentError>(HasSubstr("clean.csv is the name of a file")));
  asked.output = folder_ / "clean.csv/";
  EXPECT_EQ(plan_outputs(asked).clean.size(), 2u);
}

TEST_F(Outputs, AnOutputThatIsAnInputIsRefusedByWhateverName) {
  touch("in/walk.csv");
  fs::create_directory_symlink(folder_ / "in", folder_ / "link");
  OutputRequest in_place = request();
  in_place.output = folder_ / "link";
  OutputRequest hard_link = request();
  fs::create_directory(folder_ / "out");
  fs::create_hard_link(folder_ / "in/walk.csv", folder_ / "out/walk.csv");

  for (OutputRequest* asked : {&in_place, &hard_link}) {
    EXPECT_THAT([&] { plan_outputs(*asked); },
                ThrowsMessage<ArgumentError>(
                    AllOf(HasSubstr("walk.csv is an input"), HasSubstr("--force"))));
    asked->force = true;
    EXPECT_EQ(plan_outputs(*asked).clean.size(), 1u);
  }
}

TEST_F(Outputs, AResultOverAnotherInputIsRefusedThoughItsOwnIsKept) {
  for (const char* name : {"in/walk.csv", "in/walk.npy"}) touch(name);
  OutputRequest asked = request();
  asked.output = folder_ / "in";
  asked.keep_raw = true;
  EXPECT_EQ(plan_outputs(asked).copies[0].size(), 1u);

  asked.formats = {"", "csv"};
  EXPECT_THROW(plan_outputs(asked), ArgumentError);
}

TEST_F(Outputs, ATruthIsNotReplaced) {
  touch("in/walk.csv");
  touch("out/walk.csv");
  OutputRequest asked = request();
  asked.also_read = {folder_ / "out/walk.csv"};

  EXPECT_THROW(plan_outputs(asked), ArgumentError);
}

TEST_F(Outputs, AKeptInputIsReadAgainWhereItsResultReplacedIt) {
  touch("in/walk.csv", "result");
  touch("in/walk.raw.csv", "kept");
  OutputRequest asked = request();
  asked.output = folder_ / "in";
  asked.keep_raw = true;
  EXPECT_THAT([&] { plan_outputs(asked); },
              ThrowsMessage<ArgumentError>(HasSubstr("walk.raw.csv was kept of an earlier")));

  asked.is_result = [](const fs::path& file) { return file.filename() == "walk.csv"; };
  const OutputPlan plan = plan_outputs(asked);

  EXPECT_THAT(in_folder(plan.sources), ElementsAre("in/walk.raw.csv"));
  EXPECT_THAT(in_folder(plan.clean), ElementsAre("in/walk.csv"));
  EXPECT_THAT(plan.copies[0], IsEmpty());
}

}  // namespace
}  // namespace moclean
