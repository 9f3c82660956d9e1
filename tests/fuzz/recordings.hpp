#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "moclean/formats/format.hpp"

#include "fuzz/memory_use.hpp"

namespace moclean::fuzz {

/// A format as a target: how its files are read from memory and written, and what is not promised.
struct Codec {
  const Format& format;
  Recording (*read)(std::string_view content, const std::filesystem::path& file,
                    const ReadOptions& options);
  bool rounds_changes = false;      ///< to the decimals that the file uses
  bool holds_infinite = false;      ///< samples may be so
  bool cuts_while_reading = false;  ///< what is cut later has no source
  bool copies_unread = false;       ///< parts of the file, which may be damaged
  /// Columns and separators are told by values where names do not tell, so that a part of the file,
  /// or a changed one, may be read otherwise, or not at all.
  bool guesses_columns = false;
  MemoryBound bound = {};
};

/// What a codec makes of an input; nothing where it refuses it. Throws Violation unless the memory
/// stays within the bound and the recording is one: at least one frame and column, no infinite
/// number, as many names as columns.
std::optional<Recording> read_input(const Codec& codec, std::string_view input,
                                    const ReadOptions& options = {});

/// Reads an input and writes what was read: as the file it was, and then without its first frame,
/// with one sample changed, or as a new file, which of these depends on the input. Throws Violation
/// unless each, read again, is the same recording.
void read_and_write(const Codec& codec, std::string_view input, const ReadOptions& options = {});

}  // namespace moclean::fuzz
