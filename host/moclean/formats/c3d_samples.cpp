#include "moclean/formats/c3d_samples.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/large_memory.hpp"

namespace moclean {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr int coordinates_and_word = 4;

// The fourth number of a point is a 16-bit word with sign: the cameras that saw it above, the
// residual below. In files of reals it is a real of that value, and some programs (Qualisys Track
// Manager 2.9) store -1 as 65535.
bool is_invalid(double word) { return !(word >= 0 && word < 32768); }

// Exactly at the origin and not measured. A negative zero is none: the Encoder writes it for a
// point that is there.
bool is_mark(double x, double y, double z, double word) {
  return x == 0 && y == 0 && z == 0 && word == 0 && !std::signbit(x);
}

// Readers of one number at an address, as coordinates need it and as the word does.
struct IntelReal {
  static constexpr std::size_t size = 4;
  double coordinate(const char* at) const {
    float value;
    std::memcpy(&value, at, sizeof value);
    return static_cast<double>(value);
  }
  double word(const char* at) const { return coordinate(at); }
};

struct AnyReal {
  static constexpr std::size_t size = 4;
  double coordinate(const char* at) const { return numbers.real(at); }
  double word(const char* at) const { return numbers.real(at); }
  C3dNumbers numbers;
};

struct ScaledInteger {
  static constexpr std::size_t size = 2;
  double coordinate(const char* at) const { return numbers.integer(at) * scale; }
  double word(const char* at) const { return numbers.integer(at); }
  C3dNumbers numbers;
  double scale;
};

template <class Reader>
class Decoder {
 public:
  Decoder(const C3dFile& c3d, Reader reader, const std::filesystem::path& file)
      : c3d_(c3d),
        reader_(reader),
        file_(file),
        at_origin_(c3d.coordinates.size()),
        elsewhere_(c3d.coordinates.size()) {}

  Matrix decode() {
    Matrix samples(c3d_.layout.frames, static_cast<Index>(3 * c3d_.coordinates.size()));
    wish_huge_pages(samples.data(), static_cast<std::size_t>(samples.size()) * sizeof(double));
    for (Index f = 0; f < samples.rows(); ++f) frame(f, samples.row(f).data());
    for (std::size_t p = 0; p < at_origin_.size(); ++p)
      if (at_origin_[p] && elsewhere_[p]) leave_origin(p, samples);
    return samples;
  }

 private:
  const char* point(Index f, std::size_t p) const {
    return c3d_.bytes.data() + c3d_.layout.data_start +
           static_cast<std::size_t>(f) * c3d_.layout.frame_bytes() +
           static_cast<std::size_t>(c3d_.coordinates[p]) * coordinates_and_word * Reader::size;
  }

  void frame(Index f, double* out) {
    const std::size_t points = c3d_.coordinates.size();
    for (std::size_t p = 0; p < points; ++p, out += 3) {
      const char* at = point(f, p);
      const double x = reader_.coordinate(at), y = reader_.coordinate(at + Reader::size),
                   z = reader_.coordinate(at + 2 * Reader::size),
                   word = reader_.word(at + 3 * Reader::size);
      const bool invalid = is_invalid(word);
      out[0] = invalid ? nan : x + 0.0;  // no negative zero
      out[1] = invalid ? nan : y + 0.0;
      out[2] = invalid ? nan : z + 0.0;
      if (invalid) continue;
      if ((x + y + z) * 0 != 0) require_finite(f, p, {x, y, z});
      if (is_mark(x, y, z, word))
        at_origin_[p] = 1;
      else
        elsewhere_[p] = 1;
    }
  }

  void leave_origin(std::size_t p, Matrix& samples) const {
    for (Index f = 0; f < samples.rows(); ++f) {
      auto sample = samples.row(f).segment<3>(static_cast<Index>(3 * p));
      const char* at = point(f, p);
      if (is_mark(reader_.coordinate(at), sample[1], sample[2],
                  reader_.word(at + 3 * Reader::size)))
        sample.setConstant(nan);
    }
  }

  void require_finite(Index f, std::size_t p, const std::array<double, 3>& sample) const {
    for (const double value : sample)
      if (std::isinf(value))
        throw FileError(
            file_, fmt::format("byte {}: expected finite coordinates of point {} in "
                               "frame {}, found {}",
                               point(f, p) - c3d_.bytes.data(), c3d_.coordinates[p] + 1, f, value));
  }

  const C3dFile& c3d_;
  Reader reader_;
  const std::filesystem::path& file_;
  std::vector<char> at_origin_, elsewhere_;  // per point: in some frame
};

// How points are stored.
class Encoder {
 public:
  Encoder(const C3dLayout& layout, const std::filesystem::path& file)
      : layout_(layout), file_(file) {}

  // Coordinates alone.
  void put(char* at, const double* sample) const {
    for (std::size_t i = 0; i < 3; ++i) number(at, i, sample[i] == 0 ? 0 : sample[i]);
    const bool at_origin = sample[0] == 0 && sample[1] == 0 && sample[2] == 0;
    if (at_origin && has_negative_zero()) number(at, 0, -0.0);
  }

  // So that the point is there.
  void put_origin(char* at) const {
    if (has_negative_zero())
      number(at, 0, -0.0);
    else
      put_word(at, 1);
  }

  void put_word(char* at, int word) const {
    if (layout_.is_float)
      copy(layout_.numbers.real_bytes(word), at + 12);
    else
      copy(layout_.numbers.word_bytes(static_cast<unsigned>(word) & 0xFFFF), at + 6);
  }

 private:
  bool has_negative_zero() const {
    return layout_.is_float && layout_.numbers.processor() != C3dProcessor::dec;
  }

  void number(char* at, std::size_t place, double value) const {
    if (layout_.is_float) {
      if (std::abs(value) > layout_.numbers.largest())
        throw FileError(file_, fmt::format("cannot be written: C3D has no room for the coordinate "
                                           "{}, only up to {:.3g}",
                                           value, layout_.numbers.largest()));
      copy(layout_.numbers.real_bytes(value), at + 4 * place);
    } else {
      const auto integer = static_cast<int>(std::nearbyint(value / layout_.scale));
      copy(layout_.numbers.word_bytes(static_cast<unsigned>(integer) & 0xFFFF), at + 2 * place);
    }
  }

  template <std::size_t Size>
  static void copy(const std::array<char, Size>& bytes, char* at) {
    std::memcpy(at, bytes.data(), Size);
  }

  const C3dLayout& layout_;
  const std::filesystem::path& file_;
};

bool is_missing(const double* sample) {
  return std::isnan(sample[0]) || std::isnan(sample[1]) || std::isnan(sample[2]);
}

bool is_same(const double* a, const double* b) {
  for (std::size_t i = 0; i < 3; ++i)
    if (!(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i])))) return false;
  return true;
}

// What a stored point is to the Decoder.
enum class StoredPoint { invalid, at_origin, elsewhere };

StoredPoint stored_point(const char* at, const C3dLayout& layout) {
  const std::size_t size = layout.number_bytes();
  std::array<double, coordinates_and_word> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = layout.is_float ? layout.numbers.real(at + i * size)
                                 : layout.numbers.integer(at + i * size);
  const auto& [x, y, z, word] = numbers;
  if (is_invalid(word)) return StoredPoint::invalid;
  return is_mark(x, y, z, word) ? StoredPoint::at_origin : StoredPoint::elsewhere;
}

// Whether 0, 0, 0 is a place or means missing depends on the other frames, of which some have
// changed or are left out: says again which it is for each frame of a point. A point that is there
// gets a negative zero or, where numbers have none, a residual of one unit.
void tell_origins(std::string& data, const C3dLayout& layout, Index point,
                  const ConstMatrixRef& samples, Index column, const Encoder& encoder) {
  const auto at = [&](Index f) {
    const auto place =
        static_cast<std::size_t>(f) * layout.frame_bytes() +
        static_cast<std::size_t>(coordinates_and_word * point) * layout.number_bytes();
    return data.data() + place;
  };
  std::vector<Index> at_origin;
  bool elsewhere = false;
  for (Index f = 0; f < samples.rows(); ++f) {
    const StoredPoint stored = stored_point(at(f), layout);
    if (stored == StoredPoint::at_origin) at_origin.push_back(f);
    elsewhere = elsewhere || stored == StoredPoint::elsewhere;
  }
  for (const Index f : at_origin) {
    const bool missing = is_missing(samples.row(f).data() + column);
    if (missing == elsewhere) continue;
    if (missing)
      encoder.put_word(at(f), -1);
    else
      encoder.put_origin(at(f));
  }
}

std::int64_t& count_of(C3dChanges& changes, bool was_missing, bool is_now_missing, Index point) {
  auto& counts = is_now_missing ? changes.lost : was_missing ? changes.filled : changes.corrected;
  return counts[static_cast<std::size_t>(point)];
}

}  // namespace

Matrix c3d_samples(const C3dFile& c3d, const std::filesystem::path& file) {
  const C3dLayout& layout = c3d.layout;
  if (!layout.is_float)
    return Decoder(c3d, ScaledInteger{layout.numbers, layout.scale}, file).decode();
  if (layout.numbers.processor() == C3dProcessor::intel &&
      std::endian::native == std::endian::little)
    return Decoder(c3d, IntelReal{}, file).decode();
  return Decoder(c3d, AnyReal{layout.numbers}, file).decode();
}

bool C3dChanges::any() const {
  const auto some = [](const std::vector<std::int64_t>& counts) {
    return std::ranges::any_of(counts, [](std::int64_t count) { return count > 0; });
  };
  return some(filled) || some(corrected) || some(lost);
}

C3dChanges put_c3d_samples(std::string& data, const C3dLayout& layout,
                           const std::vector<Index>& coordinates, const ConstMatrixRef& before,
                           const ConstMatrixRef& after, const std::filesystem::path& file) {
  const auto points = static_cast<std::size_t>(layout.points);
  C3dChanges changes{std::vector<std::int64_t>(points), std::vector<std::int64_t>(points),
                     std::vector<std::int64_t>(points)};
  const Encoder encoder(layout, file);
  const std::size_t size = layout.number_bytes();
  std::array<char, 16> stored{};
  for (Index f = 0; f < after.rows(); ++f)
    for (std::size_t p = 0; p < coordinates.size(); ++p) {
      const double* was = before.row(f).data() + 3 * p;
      const double* is = after.row(f).data() + 3 * p;
      if (is_same(was, is)) continue;
      char* at = data.data() + static_cast<std::size_t>(f) * layout.frame_bytes() +
                 static_cast<std::size_t>(coordinates[p]) * 4 * size;
      const bool was_missing = is_missing(was), missing = is_missing(is);
      if (was_missing && missing) continue;
      stored.fill('\0');  // a zero of every processor
      if (!missing) encoder.put(stored.data(), is);
      if (!was_missing && !missing && std::memcmp(stored.data(), at, 3 * size) == 0) continue;
      encoder.put_word(stored.data(), missing ? -1 : 0);
      std::memcpy(at, stored.data(), 4 * size);
      ++count_of(changes, was_missing, missing, coordinates[p]);
    }
  for (std::size_t p = 0; p < coordinates.size(); ++p)
    tell_origins(data, layout, coordinates[p], after, static_cast<Index>(3 * p), encoder);
  return changes;
}

bool fit_c3d_integers(const ConstMatrixRef& samples, double scale) {
  const auto stored = samples.array() / scale;
  return ((stored >= -32768.49 && stored <= 32767.49) || samples.array().isNaN()).all();
}

std::string c3d_integers_as_reals(std::string_view data, const C3dLayout& layout,
                                  bool unsigned_analog) {
  std::string reals;
  reals.reserve(2 * data.size());
  const auto per_frame = static_cast<std::size_t>(coordinates_and_word * layout.points);
  const auto all = per_frame + static_cast<std::size_t>(layout.analog);
  for (std::size_t i = 0; 2 * i + 1 < data.size(); ++i) {
    const std::size_t place = i % all;
    const char* at = data.data() + 2 * i;
    double value = layout.numbers.integer(at);
    if (place < per_frame && place % 4 < 3) value *= layout.scale;
    if (place >= per_frame && unsigned_analog) value = layout.numbers.word(at);
    const auto bytes = layout.numbers.real_bytes(value);
    reals.append(bytes.data(), bytes.size());
  }
  return reals;
}

}  // namespace moclean
