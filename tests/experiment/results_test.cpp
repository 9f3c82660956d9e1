#include "moclean/experiment/results.hpp"

#include <cmath>
#include <fstream>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/file.hpp"

#include "formats/temporary_folder.hpp"

namespace moclean::test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const CellResult one{.figures = {{"fd", 0.1}, {"seconds", 1.0 / 3}}, .frames = 7, .unconverged = 2};
const CellResult refused{.refused = "needs \"every\" sample\n", .frames = 9};

TEST(CellResults, AreFoundAgain) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "cells.jsonl";
  {
    CellResults results(file);
    EXPECT_EQ(results.find("a"), nullptr);
    results.keep("a", one);
    results.keep("b\n", refused);
    EXPECT_EQ(*results.find("a"), one);
  }

  const CellResults results(file);

  ASSERT_NE(results.find("a"), nullptr);
  EXPECT_EQ(*results.find("a"), one);
  ASSERT_NE(results.find("b\n"), nullptr);
  EXPECT_EQ(*results.find("b\n"), refused);
}

TEST(CellResults, KeepWhatHasNoValueAsNaN) {
  const TemporaryFolder folder;
  CellResults(folder.path() / "cells.jsonl").keep("a", {.figures = {{"fd", std::nan("")}}});

  const CellResults results(folder.path() / "cells.jsonl");

  EXPECT_EQ(results.find("a")->figures.count("fd"), 1U);
  EXPECT_TRUE(std::isnan(results.find("a")->figure("fd")));
  EXPECT_TRUE(std::isnan(results.find("a")->figure("position")));
}

TEST(CellResults, SurviveALineCutOffAtAnyByte) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "cells.jsonl";
  {
    CellResults results(file);
    results.keep("a", one);
    results.keep("b", refused);
  }
  const std::string text = read_file(file);
  const std::size_t first = text.find('\n') + 1;
  for (std::size_t size = first; size < text.size(); ++size) {
    std::ofstream(file, std::ios::binary) << text.substr(0, size);

    CellResults results(file);
    EXPECT_EQ(*results.find("a"), one);
    EXPECT_EQ(results.find("b"), nullptr);
    results.keep("b", refused);

    EXPECT_EQ(read_file(file), text) << size;
  }
}

TEST(CellResults, RefuseAFileOfSomethingElse) {
  const TemporaryFolder folder;
  const std::string good = R"({"key":"a","frames":1,"unconverged":0,"figures":{}})";
  for (const char* bad : {"not JSON", "[]", R"({"key":"a","frames":1,"unconverged":0})",
                          R"({"key":1,"frames":1,"unconverged":0,"figures":{}})",
                          R"({"key":"a","frames":1,"unconverged":0,"figures":{"fd":"x"}})"}) {
    const auto file = folder.file("cells.jsonl", good + "\n" + bad + "\n");

    EXPECT_THAT([&] { CellResults{file}; },
                ThrowsMessage<FileError>(HasSubstr("cells.jsonl:2: expected the result of a cell")))
        << bad;
  }
}

}  // namespace
}  // namespace moclean::test
