#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/c3d_header.hpp"
#include "moclean/formats/c3d_samples.hpp"
#include "moclean/formats/c3d_write.hpp"
#include "moclean/formats/text_scanner.hpp"

namespace moclean {
namespace {

constexpr std::size_t most_points = 65535, longest_label = 255;

std::vector<std::string> labels_of(const Recording& recording, const std::filesystem::path& file) {
  std::vector<std::string> labels;
  for (const Joint& joint : joints(recording)) {
    if (joint.columns != 3)
      throw FileError(file, fmt::format("cannot be written: C3D holds points, and column {} is no "
                                        "coordinate of one (NAME.x, NAME.y, NAME.z)",
                                        excerpt(joint.name)));
    if (joint.name.size() > longest_label)
      throw FileError(file, fmt::format("cannot be written: C3D has room for names of {} bytes, "
                                        "and {} is longer",
                                        longest_label, excerpt(joint.name)));
    labels.push_back(joint.name);
  }
  if (labels.size() > most_points)
    throw FileError(file, fmt::format("cannot be written: C3D has room for {} points, not for {}",
                                      most_points, labels.size()));
  return labels;
}

// What c3d.org recommends, so that the file can be converted to integers.
double scale_of(const Matrix& samples) {
  const double largest = samples.array().isFinite().select(samples.array().abs(), 0).maxCoeff();
  return std::clamp(largest / 32000, 1e-30, 1e+30);
}

void add_screen(C3dParameters& parameters, UpAxis up) {
  parameters.add_text("POINT", "X_SCREEN", up == UpAxis::x ? "+Y" : "+X");
  parameters.add_text("POINT", "Y_SCREEN", up == UpAxis::x ? "+X" : up == UpAxis::y ? "+Y" : "+Z");
}

void add_points(C3dParameters& parameters, const Recording& recording, double scale,
                const std::vector<std::string>& labels) {
  const auto frames = static_cast<unsigned>(std::min<Index>(recording.frames(), 65535));
  parameters.add_group("POINT", "");
  parameters.add_word("POINT", "USED", static_cast<unsigned>(labels.size()));
  parameters.add_word("POINT", "FRAMES", frames);
  if (recording.frames() > frames)
    parameters.add_real("POINT", "LONG_FRAMES", static_cast<double>(recording.frames()));
  parameters.add_word("POINT", "DATA_START", 0);
  parameters.add_real("POINT", "SCALE", -scale);
  parameters.add_real("POINT", "RATE", recording.frame_rate);
  if (recording.up) add_screen(parameters, *recording.up);
  parameters.add_text("POINT", "UNITS", recording.unit.substr(0, longest_label));
  parameters.add_texts("POINT", "LABELS", labels);
  parameters.add_texts("POINT", "DESCRIPTIONS", std::vector<std::string>(labels.size()));
}

C3dParameters parameters_of(const Recording& recording, const C3dNumbers& numbers, double scale,
                            const std::vector<std::string>& labels) {
  C3dParameters parameters(numbers);
  add_points(parameters, recording, scale, labels);
  parameters.add_group("ANALOG", "");
  parameters.add_word("ANALOG", "USED", 0);
  parameters.add_real("ANALOG", "GEN_SCALE", 1);
  parameters.add_real("ANALOG", "RATE", recording.frame_rate);
  parameters.add("ANALOG", "SCALE", 4, {0}, {});
  parameters.add("ANALOG", "OFFSET", 2, {0}, {});
  parameters.add("ANALOG", "LABELS", -1, {16, 0}, {});
  parameters.add("ANALOG", "DESCRIPTIONS", -1, {16, 0}, {});
  parameters.add("ANALOG", "UNITS", -1, {8, 0}, {});
  parameters.add_group("TRIAL", "");
  parameters.add_words("TRIAL", "ACTUAL_START_FIELD", {0, 0});
  parameters.add_words("TRIAL", "ACTUAL_END_FIELD", {0, 0});
  set_c3d_trial(parameters, 1, recording.frames());
  return parameters;
}

C3dHeader header_of(const Recording& recording, const C3dLayout& layout) {
  constexpr double events_have_labels = 12345;
  C3dHeader header(layout.numbers);
  header.set_word(C3dHeader::points, static_cast<double>(layout.points));
  header.set_word(C3dHeader::first_frame, 1);
  header.set_word(C3dHeader::last_frame, static_cast<double>(layout.frames));
  header.set_real(C3dHeader::scale, -layout.scale);
  header.set_real(C3dHeader::rate, recording.frame_rate);
  header.set_word(C3dHeader::event_key, events_have_labels);
  return header;
}

// No point is valid yet.
std::string invalid_data(const C3dLayout& layout) {
  constexpr std::size_t word_at = 12, point_bytes = 16;
  const auto word = layout.numbers.real_bytes(-1);
  std::string data(layout.data_bytes(), '\0');
  for (std::size_t point = 0; point < data.size(); point += point_bytes)
    std::memcpy(&data[point + word_at], word.data(), word.size());
  return data;
}

}  // namespace

void write_new_c3d(AtomicFile& file, const Recording& recording) {
  const std::vector<std::string> labels = labels_of(recording, file.target());
  const C3dLayout layout{.numbers = C3dNumbers(C3dProcessor::intel),
                         .scale = scale_of(recording.samples),
                         .points = static_cast<Index>(labels.size()),
                         .frames = recording.frames()};
  std::vector<Index> all;
  for (Index p = 0; p < layout.points; ++p) all.push_back(p);
  std::string data = invalid_data(layout);
  const Matrix nothing =
      Matrix::Constant(layout.frames, 3 * layout.points, std::numeric_limits<double>::quiet_NaN());
  put_c3d_samples(data, layout, all, nothing, recording.samples, file.target());
  file.write(c3d_front(header_of(recording, layout),
                       parameters_of(recording, layout.numbers, layout.scale, labels), {},
                       file.target()));
  file.write(data);
  file.write(c3d_padding(data.size()));
}

}  // namespace moclean
