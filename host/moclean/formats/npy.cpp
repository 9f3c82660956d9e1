#include "moclean/formats/npy.hpp"

#include <algorithm>
#include <any>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "moclean/core/error.hpp"
#include "moclean/formats/array_columns.hpp"
#include "moclean/formats/confidence.hpp"
#include "moclean/motion/framed_source.hpp"

namespace moclean {
namespace {

constexpr NpyType real64{.order = std::endian::native == std::endian::little ? '<' : '>'};

// Whether the numbers themselves are needed to write the array again.
bool needs_numbers(const NpyArray& array, const ArrayColumns& columns, const ReadOptions& options) {
  return array.type.is_integer() || !options.missing.empty() ||
         columns.samples.size() < array.count() / array.shape[0];
}

FramedSource source_of(const NpyArray& array, const ArrayColumns& columns,
                       const ReadOptions& options, double least_confidence) {
  NpyDocument document{.content = nullptr,
                       .array = array,
                       .samples = columns.samples,
                       .columns = columns.names,
                       .confidences = columns.confidences,
                       .least_confidence = least_confidence,
                       .missing = options.missing};
  document.array.items = {};
  if (needs_numbers(array, columns, options)) {
    document.content = std::make_shared<const std::string>(array.items);
    document.array.items = *document.content;
  }
  const std::uint64_t bytes = document.array.items.size();
  return {.file = std::move(document), .first = 0, .bytes = bytes};
}

// [frames x samples], NaN where points have none; nothing where none has.
Matrix confidence_of(const Matrix& numbers, const ArrayColumns& columns) {
  const auto has_one = [](Index confidence) { return confidence >= 0; };
  if (std::ranges::none_of(columns.confidences, has_one)) return {};
  Matrix confidence = Matrix::Constant(numbers.rows(), std::ssize(columns.samples),
                                       std::numeric_limits<double>::quiet_NaN());
  for (Index c = 0; c < confidence.cols(); ++c)
    if (const Index own = columns.confidences[static_cast<std::size_t>(c)]; own >= 0)
      confidence.col(c) = numbers.col(own);
  return confidence;
}

// An array that is written again.
class NpyRewriter {
 public:
  NpyRewriter(const NpyDocument& document, Index first, const Matrix& samples)
      : document_(document),
        first_(static_cast<std::size_t>(first)),
        samples_(samples),
        sample_of_(width(), -1),
        judged_by_(width()) {
    for (std::size_t c = 0; c < document.samples.size(); ++c) {
      sample_of_[static_cast<std::size_t>(document.samples[c])] = static_cast<Index>(c);
      if (document.confidences[c] >= 0)
        judged_by_[static_cast<std::size_t>(document.confidences[c])].push_back(
            static_cast<Index>(c));
    }
    if (document.content) places_ = places_of(document.array);
    zero_is_missing_ = has_other_confidence();
    type_ = written_type();
  }

  std::string text() const {
    std::vector<std::uint64_t> shape = document_.array.shape;
    shape[0] = static_cast<std::uint64_t>(samples_.rows());
    std::string text = npy_head(type_, shape);
    const std::size_t head = text.size();
    text.resize(head + static_cast<std::size_t>(samples_.rows()) * width() * type_.size);
    char* item = text.data() + head;
    for (Index f = 0; f < samples_.rows(); ++f)
      for (std::size_t c = 0; c < width(); ++c, item += type_.size) put(f, c, item);
    return text;
  }

 private:
  std::size_t width() const { return document_.array.count() / document_.array.shape[0]; }

  // Where every confidence is 0, as may be in a part of the frames, nobody takes it for missing.
  bool has_other_confidence() const {
    for (std::size_t c = 0; c < width(); ++c)
      for (Index f = 0; f < samples_.rows() && !judged_by_[c].empty(); ++f)
        if (const double confidence = number(f, c); confidence != 0 && !std::isnan(confidence))
          return true;
    return false;
  }

  // Integers cannot say that a sample is missing, unless the file says so itself.
  NpyType written_type() const {
    const NpyType& type = document_.array.type;
    if (!type.is_integer()) return type;
    for (std::size_t c = 0; c < width(); ++c)
      for (Index f = 0; f < samples_.rows(); ++f) {
        if (keeps(f, c, sample_of_[c])) continue;
        const double sample = samples_(f, sample_of_[c]);
        if (std::isnan(sample) || !fits(sample, type)) return real64;
      }
    return type;
  }

  const char* original(Index frame, std::size_t column) const {
    return document_.array.items.data() + (first_ + static_cast<std::size_t>(frame)) * places_.row +
           places_.columns[column];
  }

  double number(Index frame, std::size_t column) const {
    return number_at(original(frame, column), document_.array.type);
  }

  bool was_missing(Index frame, std::size_t column, Index sample) const {
    const Index confidence = document_.confidences[static_cast<std::size_t>(sample)];
    if (confidence >= 0 && zero_is_missing_ &&
        number(frame, static_cast<std::size_t>(confidence)) == 0)
      return true;
    return std::ranges::find(document_.missing, number(frame, column)) != document_.missing.end();
  }

  // Whether the array's own number stands.
  bool keeps(Index frame, std::size_t column, Index sample) const {
    if (!document_.content || sample < 0) return sample < 0;
    const double value = samples_(frame, sample);
    return number(frame, column) == value ||
           (std::isnan(value) && was_missing(frame, column, sample));
  }

  // Whether the column is the confidence 0 of a point that has coordinates now.
  bool is_of_filled(Index frame, std::size_t column) const {
    const std::vector<Index>& judged = judged_by_[column];
    return !judged.empty() && number(frame, column) == 0 &&
           !samples_.row(frame)(judged).array().isNaN().any();
  }

  void put(Index frame, std::size_t column, char* item) const {
    const Index sample = sample_of_[column];
    if (is_of_filled(frame, column))
      put_number(document_.least_confidence, type_, item);
    else if (!keeps(frame, column, sample))
      put_number(samples_(frame, sample), type_, item);
    else if (type_ == document_.array.type)
      std::copy_n(original(frame, column), type_.size, item);
    else
      put_number(number(frame, column), type_, item);
  }

  const NpyDocument& document_;
  std::size_t first_;
  const Matrix& samples_;
  NpyType type_;
  std::vector<Index> sample_of_;               // per column of the array, or -1
  std::vector<std::vector<Index>> judged_by_;  // samples, per column that is their confidence
  NpyPlaces places_;
  bool zero_is_missing_ = false;  // as a confidence
};

Recording read_npy(std::string_view content, const std::filesystem::path& file,
                   const ReadOptions& options) {
  return parse_npy(content, file, options);
}

// The document of a recording that still fits it; null if none does.
const NpyDocument* document_of(const Recording& recording, Index& first) {
  const auto* const source = std::any_cast<FramedSource>(&recording.source);
  const auto* const document = source ? std::any_cast<NpyDocument>(&source->file) : nullptr;
  if (!document || document->columns != recording.columns) return nullptr;
  first = source->first;
  const auto frames = static_cast<Index>(document->array.shape[0]);
  return first + recording.frames() <= frames ? document : nullptr;
}

}  // namespace

Recording recording_of(const NpyArray& array, const std::filesystem::path& file,
                       const ReadOptions& options) {
  require_readable_shape(array.shape, file);
  Recording recording;
  Matrix numbers = numbers_of(array);
  ArrayColumns columns = columns_of_array(array.shape, numbers, file, options);
  recording.columns = columns.names;
  recording.notes = std::move(columns.notes);
  if (static_cast<Index>(columns.samples.size()) == numbers.cols()) {
    recording.samples = std::move(numbers);
  } else {
    recording.samples = numbers(Eigen::all, columns.samples);
    const bool are_used = take_confidence(confidence_of(numbers, columns), recording);
    if (!are_used) std::ranges::fill(columns.confidences, -1);
  }
  recording.source = source_of(array, columns, options, least_confidence(recording));
  return recording;
}

Recording parse_npy(std::string_view content, const std::filesystem::path& file,
                    const ReadOptions& options) {
  const NpyArray array = parse_npy_array(content, file);
  if (!array.type.is_number())
    throw FileError(file, "holds text, expected an array of coordinates");
  return recording_of(array, file, options);
}

std::string npy_text(const Recording& recording) {
  Index first = 0;
  if (const NpyDocument* document = document_of(recording, first))
    return NpyRewriter(*document, first, recording.samples).text();
  std::string text = npy_head(real64, {static_cast<std::uint64_t>(recording.samples.rows()),
                                       static_cast<std::uint64_t>(recording.samples.cols())});
  return text.append(reinterpret_cast<const char*>(recording.samples.data()),
                     static_cast<std::size_t>(recording.samples.size()) * sizeof(double));
}

void write_npy(AtomicFile& file, const Recording& recording) { file.write(npy_text(recording)); }

constinit const Format npy_format = {
    .name = "NPY",
    .extension = ".npy",
    .notes =
        "(frames, points, 3 or 2, or 4 with a confidence) or (frames, columns), of any real or "
        "integer type; keeps shape and type",
    .content = {.gaps = true},
    .read = read_npy,
    .write = write_npy,
};

}  // namespace moclean
