#pragma once

#include <cstdlib>
#include <filesystem>

namespace moclean::test {

/// A file of the real-take collection: $MOCLEAN_DATA, else shared/data beside the checkout.
/// The caller skips its test when the file does not exist.
inline std::filesystem::path shared_data(const std::filesystem::path& name) {
  const char* place = std::getenv("MOCLEAN_DATA");
  const std::filesystem::path root =
      place ? std::filesystem::path(place)
            : std::filesystem::path(MOCLEAN_SOURCE_DIR).parent_path() / "shared" / "data";
  return root / name;
}

/// A BVH take of Debian's package assimp-testmodels: 01_01.bvh, 01_03.bvh or Boxing_Toes.bvh.
inline std::filesystem::path debian_take(const std::filesystem::path& name) {
  return std::filesystem::path("/usr/share/assimp/models/BVH") / name;
}

/// A file of tests/data in the repository.
inline std::filesystem::path test_file(const std::filesystem::path& name) {
  return std::filesystem::path(MOCLEAN_TEST_DATA) / name;
}

}  // namespace moclean::test

/// Skips the running test, visibly, when a file is not there.
#define MOCLEAN_REQUIRE_FILE(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << (path) << " is not there"
