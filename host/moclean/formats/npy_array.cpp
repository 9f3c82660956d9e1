#include "moclean/formats/npy_array.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/npy_header.hpp"
#include "moclean/formats/text_encoding.hpp"
#include "moclean/formats/text_scanner.hpp"

namespace moclean {
namespace {

constexpr std::string_view magic = "\x93NUMPY";
constexpr char native_order = std::endian::native == std::endian::little ? '<' : '>';

// Takes magic, version and header off the front of `bytes` and leaves the items.
NpyArray take_header(std::string_view& bytes, const std::filesystem::path& file) {
  if (bytes.substr(0, magic.size()) != magic)
    throw FileError(file, "expected an npy file, which starts with '\\x93NUMPY', found " +
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
  const NpyArray array = parse_npy_header(bytes.substr(start, length), file);
  bytes.remove_prefix(start + length);
  return array;
}

bool is_known(const NpyType& type) {
  constexpr std::size_t longest_text = 4 << 20;
  const std::size_t size = type.size;
  if (type.order != '<' && type.order != '>') return false;
  if (type.kind == 'U' || type.kind == 'S') return size > 0 && size <= longest_text;
  if (type.kind == 'f') return size == 2 || size == 4 || size == 8;
  return type.is_integer() && (size == 1 || size == 2 || size == 4 || size == 8);
}

[[noreturn]] void refuse(const NpyType& type, const std::filesystem::path& file) {
  switch (type.kind) {
    case 'O':
      throw FileError(file,
                      "holds a pickled Python object (a dict or list was saved), not an array of "
                      "numbers; save the array in it: numpy.save(file, data['positions'])");
    case 'V':
      throw FileError(file, "holds a structured array; save its coordinates as a plain one");
    case 'c':
      throw FileError(file, "holds complex numbers, expected real coordinates");
    case 'b':
      throw FileError(file, "holds true and false, expected coordinates");
    default:
      throw FileError(file, fmt::format("expected real numbers, integers or text ('<f8', '>f4', "
                                        "'<i4', ...), found {} of {} bytes",
                                        excerpt({&type.kind, 1}), type.size));
  }
}

// Throws unless there are exactly as many items as the shape says. Never multiplies into overflow.
void check_size(const NpyArray& array, std::size_t bytes, const std::filesystem::path& file) {
  std::string shape;
  for (const std::uint64_t extent : array.shape)
    shape += fmt::format("{}{}", shape.empty() ? "" : " x ", extent);
  const std::size_t item = std::max<std::size_t>(1, array.type.size);
  const bool is_empty = std::ranges::find(array.shape, 0U) != array.shape.end();
  std::uint64_t room = is_empty ? 0 : bytes / item;
  for (const std::uint64_t extent : array.shape)
    if (!is_empty) room /= extent;
  std::uint64_t size = room == 1 ? array.type.size : 0;
  for (const std::uint64_t extent : array.shape) size *= extent;
  if (size != bytes || (bytes == 0 && !is_empty))
    throw FileError(file, fmt::format("expected {} samples of {} bytes, found {} bytes", shape,
                                      array.type.size, bytes));
}

// Calls work(Real{}) with the type of C++ that the items have; halves are done apart.
template <class Work>
auto with_type(const NpyType& type, const Work& work) {
  const bool is_signed = type.kind == 'i';
  switch (type.size) {
    case 1:
      return is_signed ? work(std::int8_t{}) : work(std::uint8_t{});
    case 2:
      if (type.kind == 'f') return work(Eigen::half{});
      return is_signed ? work(std::int16_t{}) : work(std::uint16_t{});
    case 4:
      if (type.kind == 'f') return work(float{});
      return is_signed ? work(std::int32_t{}) : work(std::uint32_t{});
    default:
      if (type.kind == 'f') return work(double{});
      return is_signed ? work(std::int64_t{}) : work(std::uint64_t{});
  }
}

template <class Real>
double read_as(const char* bytes, bool swap) {
  std::array<char, sizeof(Real)> raw;
  std::copy_n(bytes, sizeof(Real), raw.begin());
  if (swap) std::reverse(raw.begin(), raw.end());
  return static_cast<double>(std::bit_cast<Real>(raw));
}

std::string text_at(const char* bytes, const NpyType& type) {
  if (type.kind == 'S') {
    const std::string_view text(bytes, type.size);
    return std::string(text.substr(0, text.find_last_not_of('\0') + 1));
  }
  std::string text;
  for (std::size_t i = 0; i < type.size; i += 4) {
    std::uint32_t code = 0;
    for (std::size_t b = 0; b < 4; ++b)
      code |= static_cast<std::uint32_t>(
                  static_cast<unsigned char>(bytes[i + (type.order == '<' ? b : 3 - b)]))
              << (8 * b);
    if (code != 0) put_utf8(code, text);
  }
  return text;
}

}  // namespace

std::string NpyType::text() const {
  return fmt::format("{}{}{}", size == 1 || kind == 'S' ? '|' : order, kind,
                     kind == 'U' ? size / 4 : size);
}

std::uint64_t NpyArray::count() const {
  std::uint64_t count = 1;
  for (const std::uint64_t extent : shape) count *= extent;
  return count;
}

NpyArray look_at_npy(std::string_view content, const std::filesystem::path& file) {
  NpyArray array = take_header(content, file);
  if (!is_known(array.type)) return array;
  check_size(array, content.size(), file);
  array.items = content;
  return array;
}

NpyArray parse_npy_array(std::string_view content, const std::filesystem::path& file) {
  const NpyArray array = look_at_npy(content, file);
  if (!is_known(array.type)) refuse(array.type, file);
  return array;
}

NpyPlaces places_of(const NpyArray& array) {
  const std::uint64_t rows = array.shape.empty() ? 1 : array.shape[0];
  const std::uint64_t columns = rows == 0 ? 0 : array.count() / rows;
  NpyPlaces places{.columns = {}, .row = array.type.size * (array.fortran_order ? 1 : columns)};
  for (std::uint64_t c = 0; c < columns; ++c) {
    std::uint64_t place = c;
    if (array.fortran_order) {  // the first axis runs fastest
      std::uint64_t rest = c, stride = columns * rows;
      place = 0;
      for (std::size_t axis = array.shape.size(); axis-- > 1; rest /= array.shape[axis]) {
        stride /= array.shape[axis];
        place += rest % array.shape[axis] * stride;
      }
    }
    places.columns.push_back(place * array.type.size);
  }
  return places;
}

Matrix numbers_of(const NpyArray& array) {
  const auto rows = static_cast<Index>(array.shape.empty() ? 1 : array.shape[0]);
  const NpyPlaces places = places_of(array);
  Matrix numbers(rows, static_cast<Index>(places.columns.size()));
  const bool swap = array.type.order != native_order;
  with_type(array.type, [&](auto type) {
    for (Index r = 0; r < rows; ++r) {
      const char* const row = array.items.data() + static_cast<std::size_t>(r) * places.row;
      for (std::size_t c = 0; c < places.columns.size(); ++c)
        numbers(r, static_cast<Index>(c)) = read_as<decltype(type)>(row + places.columns[c], swap);
    }
  });
  return numbers;
}

double number_at(const char* bytes, const NpyType& type) {
  return with_type(
      type, [&](auto real) { return read_as<decltype(real)>(bytes, type.order != native_order); });
}

bool fits(double number, const NpyType& type) {
  return with_type(type, [&](auto real) {
    using Item = decltype(real);
    if constexpr (std::is_integral_v<Item>) {
      const double whole = std::nearbyint(number);
      // 2^digits is the first number that is too large; it is exact, unlike the largest Item.
      const double bound = std::ldexp(1.0, std::numeric_limits<Item>::digits);
      return whole < bound && whole >= (std::is_signed_v<Item> ? -bound : 0);
    } else {
      return true;
    }
  });
}

void put_number(double number, const NpyType& type, char* bytes) {
  with_type(type, [&](auto real) {
    using Item = decltype(real);
    Item item{};
    if constexpr (std::is_integral_v<Item>)
      item = static_cast<Item>(std::nearbyint(number));
    else
      item = static_cast<Item>(number);
    auto raw = std::bit_cast<std::array<char, sizeof(Item)>>(item);
    if (type.order != native_order) std::reverse(raw.begin(), raw.end());
    std::copy(raw.begin(), raw.end(), bytes);
  });
}

std::vector<std::string> texts_of(const NpyArray& array) {
  std::vector<std::string> texts;
  if (array.count() == 0) return texts;
  const std::uint64_t rows = array.shape.empty() ? 1 : array.shape[0];
  const NpyPlaces places = places_of(array);
  for (std::uint64_t r = 0; r < rows; ++r)
    for (const std::size_t column : places.columns)
      texts.push_back(text_at(array.items.data() + r * places.row + column, array.type));
  return texts;
}

std::string npy_head(const NpyType& type, const std::vector<std::uint64_t>& shape) {
  std::string extents;
  for (const std::uint64_t extent : shape)
    extents += fmt::format("{}{}", extents.empty() ? "" : ", ", extent);
  if (shape.size() == 1) extents += ',';
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}",
                                   type.text(), extents);
  constexpr std::size_t alignment = 64, front = magic.size() + 4;
  while ((front + header.size() + 1) % alignment != 0) header += ' ';
  header += '\n';
  std::string head(magic);
  head += {'\x01', '\x00', static_cast<char>(header.size() & 0xFF),
           static_cast<char>(header.size() >> 8)};
  return head + header;
}

}  // namespace moclean
