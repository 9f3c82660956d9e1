#include "moclean/formats/npy.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/text_scanner.hpp"

namespace moclean {
namespace {

constexpr std::string_view magic = "\x93NUMPY";
constexpr char native_order = std::endian::native == std::endian::little ? '<' : '>';

// What the header says.
struct Layout {
  char byte_order = '\0';     // '<' little, '>' big
  std::size_t item_size = 0;  // 4: float32, 8: float64
  bool fortran_order = false;
  std::vector<std::uint64_t> shape;
};

// Reads the Python dictionary {'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }.
class HeaderParser {
 public:
  HeaderParser(std::string_view header, const std::filesystem::path& file)
      : file_(file), rest_(header) {}

  Layout parse() {
    bool has_descr = false, has_order = false, has_shape = false;
    expect('{');
    while (!accept('}')) {
      const std::string_view key = text();
      expect(':');
      if (key == "descr")
        has_descr = descr();
      else if (key == "fortran_order")
        has_order = fortran_order();
      else if (key == "shape")
        has_shape = shape();
      else
        fail("descr, fortran_order or shape", key);
      if (!accept(',') && next() != '}') fail("',' or '}'", rest_);
    }
    if (next() != '\0') fail("its end", rest_);
    if (!has_descr || !has_order || !has_shape)
      throw FileError(file_, "bad npy header: expected descr, fortran_order and shape");
    return layout_;
  }

 private:
  char next() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \n"), rest_.size()));
    return rest_.empty() ? '\0' : rest_.front();
  }

  bool accept(char c) {
    if (next() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }

  void expect(char c) {
    if (!accept(c)) fail(fmt::format("'{}'", c), rest_);
  }

  std::string_view text() {
    const char quote = next();
    if (quote != '\'' && quote != '"') fail("a string", rest_);
    const std::size_t end = rest_.find(quote, 1);
    if (end == std::string_view::npos) fail("a string", rest_);
    const std::string_view text = rest_.substr(1, end - 1);
    rest_.remove_prefix(end + 1);
    return text;
  }

  bool descr() {
    constexpr std::string_view known = "float32 or float64 ('<f4' '>f4' '<f8' '>f8')";
    if (next() == '[') fail(known, rest_);
    const std::string_view type = text();
    if (type != "<f4" && type != ">f4" && type != "<f8" && type != ">f8") fail(known, type);
    layout_.byte_order = type[0];
    layout_.item_size = static_cast<std::size_t>(type[2] - '0');
    return true;
  }

  bool fortran_order() {
    next();
    for (const std::string_view word : {"True", "False"})
      if (rest_.starts_with(word)) {
        rest_.remove_prefix(word.size());
        layout_.fortran_order = word == "True";
        return true;
      }
    fail("True or False", rest_);
  }

  bool shape() {
    layout_.shape.clear();
    expect('(');
    while (!accept(')')) {
      next();
      std::uint64_t extent = 0;
      const auto [after, error] =
          std::from_chars(rest_.data(), rest_.data() + rest_.size(), extent);
      if (error != std::errc()) fail("a number of frames or columns", rest_);
      rest_.remove_prefix(static_cast<std::size_t>(after - rest_.data()));
      layout_.shape.push_back(extent);
      if (!accept(',') && next() != ')') fail("',' or ')'", rest_);
    }
    return true;
  }

  [[noreturn]] void fail(std::string_view expected, std::string_view found) const {
    throw FileError(file_,
                    fmt::format("bad npy header: expected {}, found {}", expected,
                                found.empty() ? std::string("the end of it") : excerpt(found)));
  }

  const std::filesystem::path& file_;
  std::string_view rest_;
  Layout layout_;
};

// Takes magic, version and header off the front of `bytes` and leaves the samples.
Layout take_layout(std::string_view& bytes, const std::filesystem::path& file) {
  if (!bytes.starts_with(magic))
    throw FileError(file, "expected an npy file, which starts with '?NUMPY', found " +
                              (bytes.empty() ? "an empty file" : excerpt(bytes.substr(0, 6))));
  const auto byte = [&](std::size_t i) {
    return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0U;
  };
  const unsigned version = byte(6);
  if (version < 1 || version > 3)
    throw FileError(file, fmt::format("expected npy format 1, 2 or 3, found {}", version));
  const std::size_t length_bytes = version == 1 ? 2 : 4;
  std::size_t length = 0;
  for (std::size_t i = length_bytes; i-- > 0;) length = length << 8 | byte(8 + i);
  const std::size_t start = magic.size() + 2 + length_bytes;
  if (bytes.size() < start || bytes.size() - start < length)
    throw FileError(file, fmt::format("the npy header is cut short: expected {} bytes, found {}",
                                      start + length, bytes.size()));
  const Layout layout = HeaderParser(bytes.substr(start, length), file).parse();
  bytes.remove_prefix(start + length);
  return layout;
}

// Throws unless there are exactly as many samples as the shape says. Never multiplies into
// overflow.
void check_size(const Layout& layout, std::size_t bytes, const std::filesystem::path& file) {
  std::string shape;
  for (const std::uint64_t extent : layout.shape)
    shape += fmt::format("{}{}", shape.empty() ? "" : " x ", extent);
  if (layout.shape.empty() || std::count(layout.shape.begin(), layout.shape.end(), 0u) > 0)
    throw FileError(file, "expected frames and columns, found an array of shape '" + shape + "'");
  std::uint64_t room = bytes / layout.item_size;
  for (const std::uint64_t extent : layout.shape) room /= extent;
  std::uint64_t size = room == 1 ? layout.item_size : 0;
  for (const std::uint64_t extent : layout.shape) size *= extent;
  if (size != bytes)
    throw FileError(file, fmt::format("expected {} samples of {} bytes, found {} bytes", shape,
                                      layout.item_size, bytes));
}

template <class Real>
double sample(const char* bytes, bool swap) {
  std::array<char, sizeof(Real)> raw;
  std::copy_n(bytes, sizeof(Real), raw.begin());
  if (swap) std::reverse(raw.begin(), raw.end());
  return static_cast<double>(std::bit_cast<Real>(raw));
}

// Where, in samples, the first frame of each column lies in Fortran order: the first axis runs
// fastest, whereas our columns count through the other axes with the last one fastest.
std::vector<std::size_t> fortran_columns(const std::vector<std::uint64_t>& shape, Index columns) {
  std::vector<std::size_t> places;
  for (Index c = 0; c < columns; ++c) {
    auto rest = static_cast<std::uint64_t>(c);
    std::uint64_t place = 0;
    std::uint64_t stride = static_cast<std::uint64_t>(columns) * shape[0];
    for (std::size_t axis = shape.size(); axis-- > 1; rest /= shape[axis]) {
      stride /= shape[axis];
      place += rest % shape[axis] * stride;
    }
    places.push_back(place);
  }
  return places;
}

template <class Real>
Matrix samples(std::string_view bytes, const Layout& layout) {
  const auto frames = static_cast<Index>(layout.shape[0]);
  const Index columns = static_cast<Index>(bytes.size() / sizeof(Real)) / frames;
  const bool swap = layout.byte_order != native_order;
  std::vector<std::size_t> places(static_cast<std::size_t>(columns));
  std::size_t stride = 1;  // from frame to frame
  if (layout.fortran_order) {
    places = fortran_columns(layout.shape, columns);
  } else {
    for (std::size_t c = 0; c < places.size(); ++c) places[c] = c;
    stride = places.size();
  }
  Matrix result(frames, columns);
  for (Index f = 0; f < frames; ++f)
    for (Index c = 0; c < columns; ++c) {
      const std::size_t place =
          static_cast<std::size_t>(f) * stride + places[static_cast<std::size_t>(c)];
      result(f, c) = sample<Real>(bytes.data() + place * sizeof(Real), swap);
    }
  return result;
}

Recording read_npy(std::string_view content, const std::filesystem::path& file,
                   const ReadOptions&) {
  return parse_npy(content, file);
}

}  // namespace

Recording parse_npy(std::string_view bytes, const std::filesystem::path& file) {
  const Layout layout = take_layout(bytes, file);
  check_size(layout, bytes.size(), file);
  Recording clip;
  clip.samples =
      layout.item_size == 4 ? samples<float>(bytes, layout) : samples<double>(bytes, layout);
  clip.columns = default_column_names(clip.samples.cols());
  return clip;
}

void write_npy(AtomicFile& file, const Recording& clip) {
  std::string header =
      fmt::format("{{'descr': '{}f8', 'fortran_order': False, 'shape': ({}, {}), }}", native_order,
                  clip.samples.rows(), clip.samples.cols());
  constexpr std::size_t alignment = 64, front = magic.size() + 4;
  while ((front + header.size() + 1) % alignment != 0) header += ' ';
  header += '\n';

  file.write(magic);
  file.write({"\x01\x00", 2});
  const std::array<char, 2> length = {static_cast<char>(header.size() & 0xFF),
                                      static_cast<char>(header.size() >> 8)};
  file.write({length.data(), length.size()});
  file.write(header);
  file.write({reinterpret_cast<const char*>(clip.samples.data()),
              static_cast<std::size_t>(clip.samples.size()) * sizeof(double)});
}

constinit const Format npy_format = {
    .name = "NPY",
    .extension = ".npy",
    .notes = "float32 or float64 in, float64 out, frames x columns",
    .content = {.gaps = true},
    .read = read_npy,
    .write = write_npy,
};

}  // namespace moclean
