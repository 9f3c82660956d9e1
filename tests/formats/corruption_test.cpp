#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "moclean/core/error.hpp"
#include "moclean/core/random.hpp"
#include "moclean/formats/amc.hpp"
#include "moclean/formats/bvh.hpp"
#include "moclean/formats/c3d.hpp"
#include "moclean/formats/csv.hpp"
#include "moclean/formats/npy.hpp"
#include "moclean/formats/table_document.hpp"
#include "moclean/formats/trc.hpp"

#include "formats/c3d_maker.hpp"
#include "formats/table_text.hpp"
#include "formats/tiny_files.hpp"

namespace moclean {
namespace {

struct Format {
  std::string name;
  std::string file;  // a valid one
  std::function<Recording(std::string_view)> parse;
};

std::string tiny_npy() {
  const std::string header = "{'descr': '<f8', 'fortran_order': True, 'shape': (2, 2, 3), }\n";
  return std::string("\x93NUMPY\x01\0", 8) + static_cast<char>(header.size()) + '\0' + header +
         std::string(96, '?');
}

std::string wide(std::string_view ascii) {
  std::string bytes = "\xFF\xFE";
  for (const char c : ascii) bytes.append({c, '\0'});
  return bytes;
}

std::vector<Format> formats() {
  const auto parse_table = [](std::string_view text) { return parse_csv(text, "x.csv"); };
  const auto asf = [](std::string_view text) { return parse_asf(text, "x.asf"); };
  return {
      {"bvh", std::string(test::tiny_bvh),
       [](std::string_view text) { return joint_positions(parse_bvh(text, "x.bvh")); }},
      {"asf", std::string(test::tiny_asf),
       [asf](std::string_view text) {
         const AcclaimSkeleton skeleton = asf(text);
         return joint_positions(
             {skeleton.skeleton, Matrix::Zero(1, skeleton.skeleton.channels()), 0, ""});
       }},
      {"amc", std::string(test::tiny_amc),
       [skeleton = asf(test::tiny_asf)](std::string_view text) {
         return joint_positions(parse_amc(text, "x.amc", skeleton));
       }},
      {"trc", std::string(test::tiny_trc),
       [](std::string_view text) { return parse_trc(text, "x.trc"); }},
      {"csv", std::string(test::tiny_csv),
       [](std::string_view text) { return parse_csv(text, "x.csv"); }},
      {"utf16_csv", wide(test::tiny_csv), parse_table},
      {"motive",
       "Format Version,1.2,Export Frame Rate,100,Total Exported Frames,2\n\n,Type,Marker,"
       "Marker,Marker\n,Name,A,A,A\n,,Position,Position,Position\nFrame,Time,X,Y,Z\n"
       "0,0,1,2,3\n1,0.01,,,\n",
       parse_table},
      {"nexus",
       "Trajectories\n100\n,,A,,\nFrame,Sub Frame,X,Y,Z\n,,mm,mm,mm\n1,0,1,2,3\n2,0,,,\n\n"
       "Devices\n1000\n,,F\nFrame,Sub Frame,Fx\n,,N\n1,0,5\n",
       parse_table},
      {"qtm",
       "NO_OF_FRAMES\t2\nFREQUENCY\t100\nDATA_INCLUDED\t3D\nMARKER_NAMES\tA\n1\t2\t3\n"
       "4\t5\t6\n",
       parse_table},
      {"deeplabcut", "scorer,n,n,n\nbodyparts,a,a,a\ncoords,x,y,likelihood\n0,1,2,0.5\n1,3,4,0\n",
       parse_table},
      {"opensim", std::string(test::tiny_mot), parse_table},
      {"vectors",
       "DataRate=100\nDataType=Vec3\nUnits=mm\nendheader\ntime\ta\tb\n0\t1,2,3\t4,5,6\n"
       "0.01\t1,2,3\tnan,nan,nan\n",
       parse_table},
      {"workstation",
       "Title\nDate:\n\nTRAJECTORIES\n100,Hz\n,A,,\nField #,X,Y,Z\n1,1,2,3\n2,4,5,6\n",
       parse_table},
      {"levels", "part,a,a,a\ncoord,x,y,likelihood\nframe,,,\n0,1.5,2,0.5\n1,3,4,0\n", parse_table},
      {"clock", "Time;\"A, x\";\"A, y\"\n23:59:59,5;1,5;2\n00:00:00,0;3;4\n00:00:00,5;5;6\n",
       parse_table},
      {"trc_with_commas",
       "PathFileType  4,(X/Y/Z) x y\nDataRate,NumFrames,NumMarkers,Units\n100,,2,,1,,mm\n"
       "Frame#,Time,A,,\n,,X1,Y1,Z1\n\n1,0,1,2,3\n2,0.01,,,\n",
       [](std::string_view text) { return parse_trc(text, "x.trc"); }},
      {"c3d", test::C3dMaker{.frames = std::vector(16, std::vector<double>(8, 1.0))}.bytes(),
       [](std::string_view bytes) { return parse_c3d(bytes, "x.c3d"); }},
      {"npy", tiny_npy(), [](std::string_view text) { return parse_npy(text, "x.npy"); }}};
}

// A clip or an Error; anything else (another exception, a crash, a sanitizer's finding) fails.
bool parses(const Format& format, const std::string& text) {
  // An exact copy on the heap, so that a sanitizer sees a read one byte beyond it.
  const std::vector<char> exact(text.begin(), text.end());
  try {
    const Recording clip = format.parse({exact.data(), exact.size()});
    EXPECT_GT(clip.frames(), 0);
    EXPECT_EQ(clip.samples.cols(), static_cast<Index>(clip.columns.size()));
    return true;
  } catch (const Error&) {
    return false;
  }
}

class Corruption : public testing::TestWithParam<Format> {};

TEST_P(Corruption, EveryPrefixParsesOrThrows) {
  const Format& format = GetParam();

  for (std::size_t length = 0; length < format.file.size(); ++length)
    EXPECT_NO_THROW(parses(format, format.file.substr(0, length))) << "length " << length;

  EXPECT_TRUE(parses(format, format.file));
  EXPECT_FALSE(parses(format, format.file.substr(0, format.file.size() / 3)));
}

// A few bytes changed, taken out or put in.
std::string mutated(std::string text, Random& random) {
  using namespace std::string_literals;
  const std::string alphabet = "0123456789.-+eE{}()[]:,#'\" \t\r\nnanROOTJOINT\0\xFF"s;
  for (std::uint64_t changes = 1 + random.below(4); changes > 0; --changes) {
    const std::size_t place = random.below(text.size());
    const char byte = alphabet[random.below(alphabet.size())];
    switch (random.below(4)) {
      case 0:
        text.insert(place, 1, byte);
        break;
      case 1:
        text.erase(place, 1 + random.below(8));
        break;
      case 2:
        text.insert(place, text.substr(random.below(text.size()), random.below(60)));
        break;
      default:
        text[place] = byte;
    }
    if (text.empty()) text.push_back(' ');
  }
  return text;
}

TEST_P(Corruption, MutatedBytesParseOrThrow) {
  const Format& format = GetParam();
  Random random(2026);
  int parsed = 0;
  constexpr int count = 4000;

  for (int i = 0; i < count; ++i) {
    const std::string text = mutated(format.file, random);
    EXPECT_NO_THROW(parsed += parses(format, text)) << "mutation " << i << ":\n" << text;
  }

  // Both outcomes have to occur, or the mutations do not reach the code behind the first check.
  EXPECT_GT(parsed, count / 100);
  EXPECT_LT(parsed, count - count / 100);
}

class CorruptTables : public testing::TestWithParam<Format> {};

// Whatever is read as a table is written again as it was.
TEST_P(CorruptTables, ComeBackByteForByteIfTheyAreRead) {
  const Format& format = GetParam();
  Random random(2027);
  int count = 0;

  for (int i = 0; i < 400; ++i) {
    const std::string text = mutated(format.file, random);
    try {
      EXPECT_EQ(test::written_again(format.parse(text)), text);
      ++count;
    } catch (const Error&) {
    }
  }

  EXPECT_GT(count, 4);
}

std::vector<Format> tables() {
  std::vector<Format> found = formats();
  std::erase_if(found, [](const Format& format) {
    try {
      return !table_of(format.parse(format.file), ".csv");
    } catch (const Error&) {
      return false;
    }
  });
  return found;
}

INSTANTIATE_TEST_SUITE_P(Formats, CorruptTables, testing::ValuesIn(tables()),
                         [](const auto& format) { return format.param.name; });

INSTANTIATE_TEST_SUITE_P(Formats, Corruption, testing::ValuesIn(formats()),
                         [](const auto& format) { return format.param.name; });

}  // namespace
}  // namespace moclean
