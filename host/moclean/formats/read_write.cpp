#include "moclean/formats/read_write.hpp"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/asf.hpp"
#include "moclean/formats/formats.hpp"
#include "moclean/formats/missing_marks.hpp"

namespace moclean {
namespace {

void give_skeleton(const std::filesystem::path& asf, Recording& recording) {
  Skeleton skeleton = read_asf(asf).skeleton;
  if (!joint_parents(skeleton, recording).empty()) recording.skeleton = std::move(skeleton);
}

}  // namespace

Recording read_recording(const std::filesystem::path& file, const ReadOptions& options) {
  const Format* format = format_of(file);
  if (!format || !can_read(*format))
    throw FileError(file, "expected a file ending in " + any_extension(can_read));
  Recording recording = format->read(read_file(file), file, options);
  if (recording.frame_rate == 0) recording.frame_rate = options.rate;
  apply_missing_marks(options.missing, recording);
  warn_of_marks(recording);
  if (!recording.skeleton && !options.skeleton.empty()) give_skeleton(options.skeleton, recording);
  if (!options.frames.first && !options.frames.last) return recording;
  return select_frames(recording, options.frames, file);
}

Recording select_frames(const Recording& recording, const FrameRange& frames,
                        const std::filesystem::path& file) {
  const Index first = frames.first.value_or(0);
  const Index last = frames.last.value_or(recording.frames());
  if (first >= last || last > recording.frames())
    throw ArgumentError(fmt::format("--frames {}:{} is out of range: {} has {} frames", first,
                                    frames.last ? std::to_string(last) : "", file.string(),
                                    recording.frames()));
  return excerpt(recording, first, last);
}

void write_recording(const std::filesystem::path& file, const Recording& recording) {
  write_temporary(file, recording).commit();
}

AtomicFile write_temporary(const std::filesystem::path& file, const Recording& recording) {
  const Format* format = format_of(file);
  if (!format || !can_write(*format))
    throw FileError(file,
                    "cannot be written: expected a name ending in " + any_extension(can_write));
  AtomicFile target(file);
  format->write(target, recording);
  target.close();
  return target;
}

}  // namespace moclean
