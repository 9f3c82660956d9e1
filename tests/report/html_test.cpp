#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "moclean/core/error.hpp"
#include "moclean/report/quantised.hpp"
#include "moclean/report/report.hpp"

#include "report/sample_report.hpp"
#include "support/matrix.hpp"

namespace moclean::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

constexpr const char* hostile = "</script><b>\"&.bvh";

class Html : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!report_available()) GTEST_SKIP() << "built without libjs-three and libjs-dygraphs";
  }
};

int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
  return found;
}

// What the scripts of the page read.
nlohmann::json data_of(const std::string& page) {
  const std::string open = "id=\"data\">";
  const std::size_t begin = page.find(open) + open.size();
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

std::vector<std::int16_t> decoded(const std::string& text) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char letter : text) {
    if (letter == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(letters.find(letter));
    if ((held += 6) >= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> (held -= 8) & 0xFFU));
  }
  std::vector<std::int16_t> codes;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2)
    codes.push_back(static_cast<std::int16_t>(bytes[i] | bytes[i + 1] << 8));
  return codes;
}

Matrix samples_of(const nlohmann::json& record) {
  return restore(
      {.codes = decoded(record["codes"]), .offset = record["offset"], .step = record["step"]});
}

TEST_F(Html, HoldsTheSamplesWithinHalfAStep) {
  Report report = sample_report("walk.bvh");
  report.take->noisy = *report.take->truth;  // no gaps

  const nlohmann::json data = data_of(html(report))["take"];

  for (const auto& [name, clip] :
       {std::pair{"noisy", &report.take->noisy}, {"truth", &*report.take->truth}}) {
    const nlohmann::json record = data["clips"][name];
    const Matrix found = samples_of(record);
    ASSERT_EQ(found.rows(), 120);
    for (Index c = 0; c < 30; ++c) {
      const double step = record["step"][static_cast<std::size_t>(c)];
      EXPECT_LE(largest_difference(found.col(c), clip->samples.col(c)), 0.5001 * step);
    }
  }
}

TEST_F(Html, KeepsGapsAndMarks) {
  const Report report = sample_report("walk.bvh");

  const nlohmann::json data = data_of(html(report))["take"];

  const Matrix noisy = samples_of(data["clips"]["noisy"]);
  for (Index f : {19, 20, 29, 30}) EXPECT_EQ(std::isnan(noisy(f, 13)), f == 20 || f == 29);
  const Matrix corrections = samples_of(data["corrections"]);
  EXPECT_TRUE(std::isnan(corrections(25, 4)));
  EXPECT_GT(corrections(30, 4), 0.1);
  EXPECT_EQ(data["figures"]["observed"], 120 * 30 - 36);
}

TEST_F(Html, EscapesWhatNamesHold) {
  Report report = sample_report(hostile);
  const std::string joint = "<!-- \xff \xe2\x80\xa8";  // a comment, no UTF-8, a line end
  for (std::size_t axis = 0; axis < 3; ++axis)
    report.take->noisy.columns[axis] = joint + "." + "xyz"[axis];

  const std::string page = html(report);
  const std::string plain = html(sample_report("walk.bvh"));

  EXPECT_EQ(count(page, "</script"), count(plain, "</script"));
  EXPECT_EQ(count(page, "<b>"), count(plain, "<b>"));  // of a library
  EXPECT_EQ(count(page, "<!--"), 1);                   // the licenses
  EXPECT_THAT(page, HasSubstr("<title>&lt;/script&gt;&lt;b&gt;&quot;&amp;.bvh - moclean</title>"));
  EXPECT_EQ(data_of(page)["title"], hostile);
}

TEST_F(Html, LoadsNothingFromElsewhere) {
  const std::string page = html(sample_report("walk.bvh"));

  for (const char* element : {"<script src", "<link rel=\"style", "<img", "@import", "url("})
    EXPECT_EQ(count(page, element), 0) << element;
  EXPECT_THAT(page, Not(HasSubstr("sourceMappingURL")));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(page, HasSubstr("Permission is hereby granted"));
}

// 3 clips x 10 000 x 93 x 2 bytes x 4/3 = 7.4 MB, |E| 0.8 MB, libraries 1.1 MB.
TEST_F(Html, StaysSmallForTenThousandFrames) {
  const std::string page = html({.title = "long.bvh", .take = noisy_take(10000, 31)});

  EXPECT_LT(page.size(), 12e6);
  EXPECT_EQ(data_of(page)["take"]["frames"], 10000);
}

TEST_F(Html, ShowsTablesWithoutATake) {
  Report report = sample_report("comparison");
  report.take.reset();

  const nlohmann::json data = data_of(html(report));

  EXPECT_TRUE(data["take"].is_null());
  EXPECT_EQ(data["tables"][0]["title"], "Ranking");
  EXPECT_EQ(data["tables"][0]["rows"][1], nlohmann::json({"<median>", 0.09, 0.01}));
  EXPECT_TRUE(data["tables"][0]["rows"][2][1].is_null());
  EXPECT_EQ(data["parameters"][1], nlohmann::json({"method", "slra"}));
}

TEST_F(Html, RejectsPartsThatDoNotFit) {
  Report report = sample_report("walk.bvh");
  report.tables[0].rows[1].pop_back();
  EXPECT_THAT([&] { html(report); },
              ThrowsMessage<ShapeError>(HasSubstr("has 3 columns and a row of 2")));

  report = sample_report("walk.bvh");
  report.take->parents.back() = 10;
  EXPECT_THAT([&] { html(report); }, ThrowsMessage<ShapeError>(HasSubstr("skeleton")));
}

TEST(Report, SaysWhatToInstallWhereItsLibrariesAreMissing) {
  if (report_available()) GTEST_SKIP() << "the libraries are there";

  EXPECT_THAT([] { html({.title = "walk.bvh"}); },
              ThrowsMessage<Error>(HasSubstr("install libjs-three and libjs-dygraphs")));
}

}  // namespace
}  // namespace moclean::test
