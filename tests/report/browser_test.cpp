// The page in a browser: it loads without an error, moves, and shows what is picked.

#include "report/browser.hpp"

#include <gmock/gmock.h>

#include "moclean/formats/file.hpp"
#include "moclean/report/report.hpp"

#include "formats/temporary_folder.hpp"
#include "report/sample_report.hpp"

namespace moclean::test {
namespace {

using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::EndsWith;
using ::testing::IsEmpty;
using ::testing::StartsWith;

struct Window {
  const char* name;
  Graphics graphics;
  int width;
  std::vector<std::string> labels;  // of the panels: side by side where there is room
};

class Page : public ::testing::TestWithParam<Window> {
 protected:
  void SetUp() override {
    if (!Browser::installed()) GTEST_SKIP() << "chromium is not installed (scripts/setup test)";
    if (!report_available()) GTEST_SKIP() << "built without libjs-three and libjs-dygraphs";
  }
};

TEST_P(Page, ShowsAReportThatCanBeUsed) {
  const TemporaryFolder folder;
  const auto& [name, graphics, width, labels] = GetParam();
  Browser browser(graphics, width, 900, folder.path() / "profile");
  browser.open(folder.file("report.html", html(sample_report("</script><b>.bvh"))));

  const nlohmann::json seen =
      browser.evaluate(read_file(MOCLEAN_SOURCE_DIR "/tests/report/probe.js"));

  EXPECT_THAT(browser.problems(), IsEmpty());
  EXPECT_THAT(browser.requests(), Each(AnyOf(StartsWith("file://"), StartsWith("data:"))));
  EXPECT_THAT(browser.requests(), Contains(EndsWith("/report.html")).Times(1));
  EXPECT_EQ(seen["heading"], "</script><b>.bvh");
  EXPECT_EQ(seen["bold"], 0);
  EXPECT_THAT(seen["verdict"].get<std::string>(), StartsWith("The take got better: 10.0 times"));
  EXPECT_LE(seen["overflow"], 0);

  // It opens where most was gained.
  EXPECT_EQ(seen["opening"].get<int>() % 3, 0);
  EXPECT_GT(seen["opening"], 0);

  // The player moves, and stops.
  EXPECT_EQ(seen["drawing"], graphics == Graphics::webgl ? "webgl" : "canvas");
  EXPECT_EQ(seen["labels"].get<std::vector<std::string>>(), labels);
  EXPECT_EQ(seen["sought"], 5);
  EXPECT_EQ(seen["playing"], "Pause");
  EXPECT_GT(seen["played"], 10);
  EXPECT_GT(seen["drawnFrame"], 10);
  EXPECT_EQ(seen["stopped"], seen["stayed"]);
  EXPECT_EQ(seen["pictureMoves"], true);
  EXPECT_EQ(seen["pictureReturns"], true);

  // The picked joint's curves show.
  EXPECT_EQ(seen["curveOf"], "joint7");
  EXPECT_EQ(seen["charts"], 3);
  EXPECT_GT(seen["cleanPixels"], 100);
  EXPECT_GT(seen["markPixels"], 20);
  EXPECT_GT(seen["bandPixels"], 50) << "the band is not as opaque as the curve";
  EXPECT_EQ(seen["legendsOverCharts"], 0);
  EXPECT_EQ(seen["filledPixels"], nlohmann::json({0, 1}))
      << "joint7 has no filled entry, joint2 has";

  // What was corrected and filled stands out, in either drawing of the bodies.
  EXPECT_EQ(seen["highlighted"], nlohmann::json({10, 10})) << "frame 30: the noisy body's joints";
  EXPECT_EQ(seen["highlightedWhereFilled"], nlohmann::json({10, 10}))
      << "frame 36, one of them filled";
  EXPECT_GE(seen["pickedByClicks"], 5);

  // The heat map and the lists lead somewhere.
  EXPECT_EQ(seen["heatFrame"], 119);
  EXPECT_EQ(seen["heatJoint"], "4");
  EXPECT_EQ(seen["gap"], "frame 25, joint4: gap");
  EXPECT_EQ(seen["keyed"], nlohmann::json({26, 5}));
  EXPECT_EQ(seen["worst"].get<int>() % 3, 0);  // frames between have no error
  EXPECT_EQ(seen["least"], "<median>");
  EXPECT_EQ(seen["most"], "slra");
  EXPECT_EQ(seen["badSegments"], 1);
}

INSTANTIATE_TEST_SUITE_P(
    Windows, Page,
    ::testing::Values(Window{"Wide", Graphics::webgl, 1280, {"Noisy", "Clean", "Truth"}},
                      Window{"Narrow", Graphics::canvas_only, 390, {"Noisy Clean Truth"}}),
    [](const auto& window) { return window.param.name; });

}  // namespace
}  // namespace moclean::test
