#include "moclean/formats/c3d.hpp"

#include <any>
#include <utility>

#include "moclean/formats/c3d_samples.hpp"
#include "moclean/formats/c3d_write.hpp"
#include "moclean/motion/framed_source.hpp"

namespace moclean {
namespace {

Recording read_c3d(std::string_view content, const std::filesystem::path& file,
                   const ReadOptions&) {
  return parse_c3d(content, file);
}

// Null if the recording is not some frames of a C3D file.
const C3dFile* file_of(const FramedSource* source, const Recording& recording) {
  const C3dSource* c3d = source ? std::any_cast<C3dSource>(&source->file) : nullptr;
  const bool has_frames = c3d && source->first + recording.frames() <= c3d->c3d->layout.frames;
  return has_frames && recording.columns == c3d->c3d->columns ? c3d->c3d.get() : nullptr;
}

}  // namespace

Recording parse_c3d(std::string_view bytes, const std::filesystem::path& file) {
  const auto c3d = std::make_shared<const C3dFile>(parse_c3d_file(bytes, file));
  Recording recording{.samples = c3d_samples(*c3d, file),
                      .columns = c3d->columns,
                      .frame_rate = c3d_rate(*c3d),
                      .unit = c3d->parameters.text("POINT", "UNITS"),
                      .up = c3d_up(*c3d)};
  recording.source = FramedSource{.file = C3dSource{c3d}, .first = 0, .bytes = bytes.size()};
  return recording;
}

void write_c3d(AtomicFile& file, const Recording& recording) {
  const auto* source = std::any_cast<FramedSource>(&recording.source);
  if (const C3dFile* c3d = file_of(source, recording))
    write_in_c3d(file, *c3d, source->first, recording);
  else
    write_new_c3d(file, recording);
}

constinit const Format c3d_format = {
    .name = "C3D",
    .extension = ".c3d",
    .notes =
        "numbers of Intel, DEC, MIPS; C3D in, C3D out keeps all else of the file byte for byte "
        "(docs/formats.md)",
    .content = {.names = true,
                .frame_rate = true,
                .unit = true,
                .up = true,
                .gaps = true,
                .single_precision = true},
    .read = read_c3d,
    .write = write_c3d,
};

}  // namespace moclean
