#pragma once

#include <filesystem>

#include "moclean/formats/format.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// Reads a recording; the extension chooses among formats(), in any case. Skeleton formats become
/// joint positions, three columns per joint, and the recording keeps skeleton, channels and what
/// its format needs to write the file again; what a format means in detail stands in its header.
/// Of its frames those that are asked for are kept. There is at least one frame and one column.
/// Throws FileError for an unknown extension, a file that cannot be opened, and anything in it that
/// does not parse, and as select_frames().
Recording read_recording(const std::filesystem::path& file, const ReadOptions& options = {});

/// The frames of a recording that are asked for. Throws ArgumentError naming `file` if it has
/// fewer.
Recording select_frames(const Recording& recording, const FrameRange& frames,
                        const std::filesystem::path& file);

/// Writes a recording in the format of the extension; one that cannot be written throws FileError.
/// The file appears under its name only when it is complete (temporary file, then rename).
void write_recording(const std::filesystem::path& file, const Recording& recording);

/// As write_recording(), but leaves the complete file under its temporary name: commit() puts it in
/// its place, the destructor removes it.
AtomicFile write_temporary(const std::filesystem::path& file, const Recording& recording);

}  // namespace moclean
