#include "fuzz/recordings.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "moclean/formats/formats.hpp"

#include "fuzz/target.hpp"

namespace moclean::fuzz {
namespace {

namespace fs = std::filesystem;

fs::path name_of(const Codec& codec) { return "input" + std::string(codec.format.extension); }

void expect(bool is_kept, std::string_view promise) {
  if (!is_kept) throw Violation(std::string(promise));
}

// What is written goes to a file in memory that stays open.
class Written {
 public:
  Written() : descriptor_(memfd_create("output", MFD_CLOEXEC)), file_(path()) {}

  // The bytes of a recording, or nothing where the format has no way to say it.
  std::optional<std::string> bytes_of(const Format& format, const Recording& recording) {
    expect(ftruncate(descriptor_, 0) == 0, "a file in memory can be emptied");
    if (!succeeds([&] { format.write(file_, recording); })) return std::nullopt;
    std::string bytes(static_cast<std::size_t>(lseek(descriptor_, 0, SEEK_END)), '\0');
    expect(pread(descriptor_, bytes.data(), bytes.size(), 0) == std::ssize(bytes),
           "a file in memory can be read");
    return bytes;
  }

 private:
  fs::path path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

  int descriptor_;
  AtomicFile file_;
};

std::optional<std::string> written(const Codec& codec, const Recording& recording) {
  static Written file;
  return file.bytes_of(codec.format, recording);
}

bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

void expect_same(const Matrix& before, const Matrix& after, std::string_view promise) {
  if (before.rows() != after.rows() || before.cols() != after.cols())
    throw Violation(fmt::format("{}: {} x {} become {} x {}", promise, before.rows(), before.cols(),
                                after.rows(), after.cols()));
  for (Index r = 0; r < before.rows(); ++r)
    for (Index c = 0; c < before.cols(); ++c)
      if (!same(before(r, c), after(r, c)))
        throw Violation(fmt::format("{}: {} of frame {}, column {} becomes {}", promise,
                                    before(r, c), r, c, after(r, c)));
}

void expect_recording(const Codec& codec, const Recording& recording) {
  const Matrix& samples = recording.samples;
  expect(samples.rows() >= 1 && samples.cols() >= 1, "a recording has a frame and a column");
  expect(std::cmp_equal(recording.columns.size(), samples.cols()), "a name per column");
  expect(codec.holds_infinite || !samples.array().isInf().any(), "no sample is infinite");
  expect(std::isfinite(recording.frame_rate) && recording.frame_rate >= 0, "a rate is a number");
  expect(recording.confidence.size() == 0 || (recording.confidence.rows() == samples.rows() &&
                                              recording.confidence.cols() == samples.cols()),
         "a confidence per sample");
  for (const std::string& name : recording.columns) expect_showable(name);
  for (const std::string& warning : recording.notes.warnings) expect_showable(warning);
  expect_showable(recording.notes.layout);
}

// What was written, read with the options that were used before.
std::optional<Recording> again(const Codec& codec, const std::string& bytes,
                               const ReadOptions& options) {
  std::optional<Recording> recording;
  succeeds([&] { recording = codec.read(bytes, name_of(codec), options); });
  if (recording) expect_recording(codec, *recording);
  return recording;
}

// Whether a recording that is not all of its file as it was came back understood in the same way.
bool is_comparable(const Codec& codec, const Recording& before,
                   const std::optional<Recording>& after) {
  if (codec.guesses_columns)
    return after && after->columns == before.columns && after->notes.layout == before.notes.layout;
  expect(after.has_value(), "what was written can be read");
  return true;
}

void expect_same(const Recording& before, const Recording& after) {
  expect_same(before.samples, after.samples, "samples come back");
  expect(before.columns == after.columns, "names come back");
  expect(same(before.frame_rate, after.frame_rate), "the rate comes back");
  expect(before.unit == after.unit, "the unit comes back");
  expect(before.up == after.up, "the axis that is up comes back");
  expect_same(before.confidence, after.confidence, "confidences come back");
}

// As the format can hold them: of float, and points whole or not at all.
Matrix as_held(const Codec& codec, const Recording& recording) {
  Matrix samples = recording.samples;
  if (!codec.format.content.single_precision) return samples;
  samples = samples.cast<float>().cast<double>();
  for (const Joint& point : joints(recording))
    for (Index f = 0; f < samples.rows(); ++f)
      if (auto place = samples.row(f).segment(point.first_column, point.columns);
          place.array().isNaN().any())
        place.setConstant(std::nan(""));
  return samples;
}

void write_as_it_was(const Codec& codec, const Recording& recording, const ReadOptions& options) {
  const auto bytes = written(codec, recording);
  expect(bytes || codec.copies_unread, "what was read can be written");
  if (!bytes) return;
  const auto after = again(codec, *bytes, options);
  expect(after.has_value(), "what was written again can be read");
  expect_same(recording, *after);
}

// Without the first frame.
void write_part(const Codec& codec, std::string_view input, const Recording& recording,
                const ReadOptions& options) {
  if (recording.frames() < 2) return;
  ReadOptions some = options;
  some.frames.first = 1;
  const Recording whole =
      codec.cuts_while_reading ? codec.read(input, name_of(codec), some) : recording;
  const Recording part = excerpt(whole, 1, recording.frames());
  const auto bytes = written(codec, part);
  expect(bytes || codec.copies_unread, "a part of what was read can be written");
  if (!bytes) return;
  const auto after = again(codec, *bytes, options);
  if (!after && codec.cuts_while_reading) return;  // times that agreed with the rate all in all
  if (is_comparable(codec, part, after))
    expect_same(part.samples, after->samples, "samples of a part come back");
}

// The first sample that was observed gets the value of the last one, which its type can hold.
void write_changed(const Codec& codec, Recording recording, const ReadOptions& options) {
  Matrix& samples = recording.samples;
  Index first = 0, last = samples.size() - 1;
  while (first < last && std::isnan(samples.data()[first])) ++first;
  while (first < last && std::isnan(samples.data()[last])) --last;
  if (first == last) return;
  samples.data()[first] = samples.data()[last];
  const auto bytes = written(codec, recording);
  if (!bytes) return;
  const auto after = again(codec, *bytes, options);
  if (!is_comparable(codec, recording, after)) return;
  expect(after->frames() == recording.frames(), "frames come back");
  // Positions become rotations, which bones and degrees of freedom bound.
  if (has_skeleton(codec.format) || codec.rounds_changes) return;
  expect_same(as_held(codec, recording), as_held(codec, *after),
              "a sample that was changed comes back");
}

// Under plain names: those of an input may say that a column is a time, or a quaternion.
void write_as_new(const Codec& codec, Recording recording) {
  recording.source.reset();
  if (!has_skeleton(codec.format))
    recording.columns = default_column_names(recording.samples.cols());
  recording.confidence.resize(0, 0);
  const auto bytes = written(codec, recording);
  if (!bytes) return;
  const auto after = again(codec, *bytes, {});
  expect(after.has_value(), "a new file can be read");
  expect(after->frames() == recording.frames(), "frames come back from a new file");
  if (has_skeleton(codec.format)) return;
  expect_same(as_held(codec, recording), as_held(codec, *after),
              "samples come back from a new file");
  if (codec.format.content.names)
    expect(recording.columns == after->columns, "names come back from a new file");
}

}  // namespace

std::optional<Recording> read_input(const Codec& codec, std::string_view input,
                                    const ReadOptions& options) {
  static const fs::path file = name_of(codec);
  std::optional<Recording> recording;
  const MemoryUse memory;
  succeeds([&] { recording = codec.read(input, file, options); });
  memory.expect_within(codec.bound, input.size());
  if (recording) expect_recording(codec, *recording);
  return recording;
}

void read_and_write(const Codec& codec, std::string_view input, const ReadOptions& options) {
  const std::optional<Recording> recording = read_input(codec, input, options);
  if (!recording) return;
  write_as_it_was(codec, *recording, options);
  // All three for every input would halve the inputs of an hour.
  switch (std::hash<std::string_view>()(input) % 3) {
    case 0:
      return write_part(codec, input, *recording, options);
    case 1:
      return write_changed(codec, *recording, options);
    default:
      return write_as_new(codec, *recording);
  }
}

}  // namespace moclean::fuzz
