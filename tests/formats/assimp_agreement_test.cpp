#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include "moclean/core/random.hpp"
#include "moclean/formats/read_write.hpp"

#include "formats/temporary_folder.hpp"
#include "support/data.hpp"
#include "support/matrix.hpp"
#include "support/tolerance.hpp"

namespace moclean {
namespace {

using Tracks = std::map<std::string, const aiNodeAnim*>;

aiMatrix4x4 local_transform(const aiNode& node, const Tracks& tracks, unsigned frame) {
  const auto found = tracks.find(node.mName.C_Str());
  if (found == tracks.end()) return node.mTransformation;
  const aiNodeAnim& track = *found->second;
  const auto key = [frame](unsigned count) { return std::min(frame, count - 1); };
  return aiMatrix4x4(aiVector3D(1, 1, 1), track.mRotationKeys[key(track.mNumRotationKeys)].mValue,
                     track.mPositionKeys[key(track.mNumPositionKeys)].mValue);
}

void place(const aiNode& node, const aiMatrix4x4& parent, const Tracks& tracks, unsigned frame,
           std::map<std::string, aiVector3D>& positions) {
  const aiMatrix4x4 world = parent * local_transform(node, tracks, frame);
  positions[node.mName.C_Str()] = {world.a4, world.b4, world.c4};
  for (unsigned c = 0; c < node.mNumChildren; ++c)
    place(*node.mChildren[c], world, tracks, frame, positions);
}

void expect_same_positions(const std::filesystem::path& file) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumAnimations, 1u);
  Tracks tracks;
  for (unsigned c = 0; c < scene->mAnimations[0]->mNumChannels; ++c) {
    const aiNodeAnim* track = scene->mAnimations[0]->mChannels[c];
    tracks[track->mNodeName.C_Str()] = track;
  }

  const Recording clip = read_recording(file);

  const std::vector<Joint> all = joints(clip);
  Matrix expected(clip.samples.rows(), clip.samples.cols());
  for (Index f = 0; f < clip.frames(); ++f) {
    std::map<std::string, aiVector3D> positions;
    place(*scene->mRootNode, aiMatrix4x4(), tracks, static_cast<unsigned>(f), positions);
    for (const Joint& joint : all) {
      ASSERT_TRUE(positions.contains(joint.name)) << joint.name;
      const aiVector3D& p = positions[joint.name];
      expected.row(f).segment<3>(joint.first_column) << p.x, p.y, p.z;
    }
  }
  // It leaves out lines beyond the stated number of frames (Boxing_Toes.bvh has one).
  const Index frames = static_cast<Index>(scene->mAnimations[0]->mDuration) + 1;
  EXPECT_THAT(clip.frames(), testing::AnyOf(frames, frames + 1));
  EXPECT_LE(test::largest_difference(clip.samples.topRows(frames), expected.topRows(frames)),
            test::tolerance::single_precision_reader() * expected.cwiseAbs().maxCoeff());
}

class AssimpAgreement : public testing::TestWithParam<std::string> {};

TEST_P(AssimpAgreement, GivesTheSameJointPositions) {
  const std::filesystem::path file = test::debian_take(GetParam());
  MOCLEAN_REQUIRE_FILE(file);

  expect_same_positions(file);
}

TEST_P(AssimpAgreement, ReadsWhatIsWrittenOfChangedPositions) {
  const std::filesystem::path file = test::debian_take(GetParam());
  MOCLEAN_REQUIRE_FILE(file);
  const test::TemporaryFolder folder;
  Recording recording = read_recording(file, {.skeleton = {}, .frames = {.first = 5, .last = 200}});
  Random random(5);
  for (double& sample : recording.samples.reshaped()) sample += 0.1 * random.normal();

  write_recording(folder.path() / "changed.bvh", recording);

  expect_same_positions(folder.path() / "changed.bvh");
}

INSTANTIATE_TEST_SUITE_P(DebianTakes, AssimpAgreement,
                         testing::Values("01_01.bvh", "01_03.bvh", "Boxing_Toes.bvh"),
                         [](const auto& take) {
                           return take.param.substr(0, take.param.find('.'));
                         });

}  // namespace
}  // namespace moclean
