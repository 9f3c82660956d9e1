#pragma once

#include <string>
#include <string_view>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/read_write.hpp"

#include "formats/temporary_folder.hpp"

namespace moclean::test {

/// Reads and writes small files under names, whose extensions tell the format.
class NamedTables : public testing::Test {
 protected:
  Recording read(const std::string& name, std::string_view text) {
    return read_recording(folder_.file(name, text));
  }

  std::string write(const std::string& name, const Recording& recording) {
    write_recording(folder_.path() / name, recording);
    return read_file(folder_.path() / name);
  }

  void expect_failure(const std::string& name, std::string_view text, const std::string& message) {
    EXPECT_THAT([&] { read(name, text); },
                testing::ThrowsMessage<FileError>(testing::HasSubstr(message)));
  }

  TemporaryFolder folder_;
};

/// A text with the first occurrence of another replaced.
inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t place = text.find(from);
  return place == text.npos ? "does not occur" : text.replace(place, from.size(), to);
}

}  // namespace moclean::test
