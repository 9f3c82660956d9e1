#include "moclean/formats/npz.hpp"

#include <map>
#include <string>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/read_write.hpp"
#include "moclean/formats/zip_archive.hpp"

#include "formats/npy_maker.hpp"
#include "formats/temporary_folder.hpp"
#include "support/matrix.hpp"

namespace moclean {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

using Members = std::map<std::string, std::string>;

const NpyType real32{'<', 'f', 4};

std::string two_frames() {
  return npy_head(real32, {2, 2, 3}) + test::bytes<float>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
}

// Two names as NumPy keeps them: '<U2'.
std::string two_names() {
  std::string text = test::npy(test::dictionary("<U2", false, "(2,)"), "");
  for (const char letter : {'A', '\0', 'B', 'C'}) text += {letter, '\0', '\0', '\0'};
  return text;
}

std::string scalar(double number) { return npy_head({}, {}) + test::bytes<double>({number}); }

std::string archive(const Members& members) { return with_members({}, members, "x.npz"); }

Recording read(const Members& members) { return parse_npz(archive(members), "x.npz"); }

TEST(Npz, ReadsPositionsNamesAndRate) {
  const Recording take = read({{"markers.npy", two_frames()},
                               {"labels.npy", two_names()},
                               {"mocap_framerate.npy", scalar(120)},
                               {"betas.npy", scalar(0)}});

  EXPECT_EQ(take.samples, (Matrix{{1, 2, 3, 4, 5, 6}, {7, 8, 9, 10, 11, 12}}));
  EXPECT_THAT(take.columns, ElementsAre("A.x", "A.y", "A.z", "BC.x", "BC.y", "BC.z"));
  EXPECT_EQ(take.frame_rate, 120);
  EXPECT_THAT(take.notes.layout, HasSubstr("member markers"));
}

TEST(Npz, TakesTheOnlyArrayOfPointsWhateverItsName) {
  EXPECT_EQ(read({{"arr_0.npy", two_frames()}, {"arr_1.npy", scalar(1)}}).frames(), 2);
  EXPECT_THAT(
      [] {
        read({{"a.npy", two_frames()}, {"b.npy", two_frames()}});
      },
      ThrowsMessage<FileError>(HasSubstr("several of its arrays may be the positions: 'a', "
                                         "'b'; call the right one `positions`")));
}

TEST(Npz, RefusesRotationsWithAWord) {
  EXPECT_THAT(
      [] {
        read({{"poses.npy", two_frames()}, {"trans.npy", two_frames()}});
      },
      ThrowsMessage<FileError>(HasSubstr("x.npz: holds rotations of joints (poses, as AMASS")));
}

TEST(Npz, RefusesWhatIsNoArchive) {
  EXPECT_THAT([] { parse_npz("not a zip file", "x.npz"); },
              ThrowsMessage<FileError>(HasSubstr("x.npz: cannot be read as a zip archive: ")));
  EXPECT_THAT(
      [] {
        read({{"readme.txt", "words"}});
      },
      ThrowsMessage<FileError>(HasSubstr("holds no array")));
  EXPECT_THAT(
      [] {
        read({{"positions.npy", "words"}});
      },
      ThrowsMessage<FileError>(HasSubstr("x.npz/positions: expected an npy file")));
  std::string damaged = archive({{"positions.npy", two_frames()}});
  damaged[150] = static_cast<char>(damaged[150] ^ 1);  // an item: the sum tells
  EXPECT_THAT([&] { parse_npz(damaged, "x.npz"); }, ThrowsMessage<FileError>(HasSubstr("damaged")));
}

TEST(Npz, IsWrittenWithItsOtherMembers) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "x.npz";
  const Members members = {{"joints.npy", two_frames()},
                           {"labels.npy", two_names()},
                           {"fps.npy", scalar(30)},
                           {"notes.txt", "kept"}};
  AtomicFile file(path);
  file.write(archive(members));
  file.commit();

  Recording take = read_recording(path);
  write_recording(path, take);
  EXPECT_EQ(ZipArchive(read_file(path), path).member("joints.npy"), members.at("joints.npy"));

  take.samples(1, 0) = 7.5;
  write_recording(path, take);
  const std::string content = read_file(path);
  const ZipArchive written(content, path);
  for (const std::string name : {"labels.npy", "fps.npy", "notes.txt"})
    EXPECT_EQ(written.member(name), members.at(name)) << name;
  EXPECT_EQ(
      written.member("joints.npy"),
      npy_head(real32, {2, 2, 3}) + test::bytes<float>({1, 2, 3, 4, 5, 6, 7.5, 8, 9, 10, 11, 12}));
}

TEST(Npz, KeepsNamesRateAndUnitOfOtherRecordings) {
  const test::TemporaryFolder folder;
  const Recording take{.samples = test::random_matrix(4, 6, 1),
                       .columns = {"Ä.x", "Ä.y", "Ä.z", "hip.x", "hip.y", "hip.z"},
                       .frame_rate = 59.94,
                       .unit = "mm"};
  write_recording(folder.path() / "x.npz", take);

  const Recording back = read_recording(folder.path() / "x.npz");

  EXPECT_EQ(back.samples, take.samples);
  EXPECT_EQ(back.columns, take.columns);
  EXPECT_EQ(back.frame_rate, 59.94);
  EXPECT_EQ(back.unit, "mm");
}

TEST(Npz, KeepsPlainChannels) {
  const test::TemporaryFolder folder;
  const Recording take{test::random_matrix(4, 2, 1), {"hip", "knee"}, 0, ""};
  write_recording(folder.path() / "x.npz", take);

  const Recording back = read_recording(folder.path() / "x.npz");

  EXPECT_EQ(back.samples, take.samples);
  EXPECT_EQ(back.columns, take.columns);
}

}  // namespace
}  // namespace moclean
