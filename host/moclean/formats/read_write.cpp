#include "moclean/formats/read_write.hpp"

#include "moclean/core/error.hpp"
#include "moclean/formats/formats.hpp"

namespace moclean {

Clip read_clip(const std::filesystem::path& file, const ReadOptions& options) {
  const Format* format = format_of(file);
  if (!format || !can_read(*format))
    throw FileError(file, "expected a file ending in " + any_extension(can_read));
  Clip clip = format->read(read_file(file), file, options);
  if (clip.frame_rate == 0) clip.frame_rate = options.rate;
  return clip;
}

void write_clip(const std::filesystem::path& file, const Clip& clip) {
  write_temporary(file, clip).commit();
}

AtomicFile write_temporary(const std::filesystem::path& file, const Clip& clip) {
  const Format* format = format_of(file);
  if (!format || !can_write(*format))
    throw FileError(file,
                    "cannot be written: expected a name ending in " + any_extension(can_write));
  AtomicFile target(file);
  format->write(target, clip);
  target.close();
  return target;
}

}  // namespace moclean
