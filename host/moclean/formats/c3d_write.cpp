#include "moclean/formats/c3d_write.hpp"

#include <algorithm>
#include <string>

#include "moclean/core/version.hpp"
#include "moclean/formats/c3d_header.hpp"
#include "moclean/formats/c3d_samples.hpp"

namespace moclean {
namespace {

constexpr std::string_view own_group = "MOCLEAN";

std::vector<double> reals(const std::vector<std::int64_t>& counts) {
  return {counts.begin(), counts.end()};
}

// The last run's: an older group of that name goes.
void list_changes(C3dParameters& parameters, const C3dChanges& changes) {
  parameters.remove_group(own_group);
  if (!parameters.add_group(own_group, "samples changed per point")) return;
  parameters.add_text(own_group, "VERSION", version());
  parameters.add_reals(own_group, "FILLED", reals(changes.filled));
  parameters.add_reals(own_group, "CORRECTED", reals(changes.corrected));
  parameters.add_reals(own_group, "REMOVED", reals(changes.lost));
}

void number_frames(C3dParameters& parameters, C3dHeader& header, Index first, Index frames) {
  const auto start = static_cast<double>(first), count = static_cast<double>(frames);
  set_c3d_trial(parameters, first, first + frames - 1);
  parameters.set("POINT", "LONG_FRAMES", {count});
  const bool is_word = !parameters.words("POINT", "FRAMES").empty();
  parameters.set("POINT", "FRAMES", {is_word ? std::min(count, 65535.0) : count});
  header.set_word(C3dHeader::first_frame, start);
  header.set_word(C3dHeader::last_frame, start + count - 1);
}

std::string part_of_data(const C3dFile& c3d, Index first, Index frames) {
  const std::size_t frame = c3d.layout.frame_bytes();
  return c3d.bytes.substr(c3d.layout.data_start + static_cast<std::size_t>(first) * frame,
                          static_cast<std::size_t>(frames) * frame);
}

bool has_unsigned_analog(const C3dParameters& parameters) {
  return parameters.text("ANALOG", "FORMAT").starts_with("UNSIGNED");
}

// Stored integers as reals, with the sign of the scale that says so.
void store_reals(std::string& data, C3dLayout& layout, C3dParameters& parameters,
                 C3dHeader& header) {
  data = c3d_integers_as_reals(data, layout, has_unsigned_analog(parameters));
  layout.is_float = true;
  parameters.set("POINT", "SCALE", {-layout.scale});
  header.set_real(C3dHeader::scale, -layout.scale);
}

// What the file has behind its data, of which nothing is known.
std::string_view tail_of(const C3dFile& c3d) {
  const std::size_t end = c3d.layout.data_start + c3d.layout.data_bytes();
  const bool holds_parameters = c3d.layout.parameter_start > c3d.layout.data_start;
  return holds_parameters ? std::string_view() : std::string_view(c3d.bytes).substr(end);
}

}  // namespace

void write_in_c3d(AtomicFile& file, const C3dFile& c3d, Index first, const Recording& recording) {
  const Matrix all = c3d_samples(c3d, file.target());
  const Index frames = recording.frames();
  const bool is_whole = frames == c3d.layout.frames;
  C3dLayout layout = c3d.layout;
  C3dParameters parameters = c3d.parameters;
  C3dHeader header(c3d);
  std::string data = part_of_data(c3d, first, frames);
  const bool fits = layout.is_float || fit_c3d_integers(recording.samples, layout.scale);
  if (!fits) store_reals(data, layout, parameters, header);
  const C3dChanges changes =
      put_c3d_samples(data, layout, c3d.coordinates, all.middleRows(first, frames),
                      recording.samples, file.target());
  if (is_whole && !changes.any()) return file.write(c3d.bytes);
  if (changes.any()) list_changes(parameters, changes);
  if (!is_whole) number_frames(parameters, header, layout.first_frame + first, frames);
  file.write(c3d_front(header, parameters, own_group, file.target()));
  file.write(data);
  if (is_whole && fits)
    file.write(tail_of(c3d));
  else
    file.write(c3d_padding(data.size()));
}

}  // namespace moclean
