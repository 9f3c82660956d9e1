#pragma once

#include <string>
#include <string_view>

#include "moclean/formats/csv.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/read_write.hpp"

#include "formats/temporary_folder.hpp"

namespace moclean::test {

inline Recording table(std::string_view text, const ReadOptions& options = {}) {
  return parse_csv(text, "tiny.csv", options);
}

/// The text of a recording written to a file of that name.
inline std::string written_again(const Recording& recording, const char* name = "out.csv") {
  const TemporaryFolder folder;
  write_recording(folder.path() / name, recording);
  return read_file(folder.path() / name);
}

}  // namespace moclean::test
