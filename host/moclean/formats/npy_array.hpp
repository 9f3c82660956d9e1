#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// The type of an array's items, as NumPy writes it (`<f4`, `>i2`, `|u1`, `<U10`): numpy.org, "NEP
/// 1, A Simple File Format for NumPy Arrays".
struct NpyType {
  char order = '<';      ///< '<' little endian, '>' big endian
  char kind = 'f';       ///< 'f' real, 'i' and 'u' integer, 'U' and 'S' text
  std::size_t size = 8;  ///< bytes of an item

  bool is_number() const { return kind == 'f' || kind == 'i' || kind == 'u'; }
  bool is_text() const { return kind == 'U' || kind == 'S'; }
  bool is_integer() const { return kind == 'i' || kind == 'u'; }
  std::string text() const;  ///< as NumPy writes it
  bool operator==(const NpyType&) const = default;
};

/// An array of an .npy file; its items stay where the file's content is.
struct NpyArray {
  NpyType type;
  bool fortran_order = false;
  std::vector<std::uint64_t> shape;
  std::string_view items;  ///< shape x type.size bytes

  std::uint64_t count() const;  ///< of items
};

/// Takes an .npy file apart; `file` names it in messages. Throws FileError for types that are
/// neither numbers nor text, and unless there are exactly as many bytes as the shape says.
NpyArray parse_npy_array(std::string_view content, const std::filesystem::path& file);

/// The same for an array that may be of any type: without items if it is neither numbers nor text,
/// pickled, say.
NpyArray look_at_npy(std::string_view content, const std::filesystem::path& file);

/// The numbers of an array, a row per index of the first axis, the other axes in the order of C
/// (the last one runs fastest). Whole numbers beyond 2^53 lose digits.
Matrix numbers_of(const NpyArray& array);

/// Where in the array's items, in bytes, the samples of a row of numbers_of() lie for row 0, and
/// how far it is to the next row.
struct NpyPlaces {
  std::vector<std::size_t> columns;
  std::size_t row = 0;
};
NpyPlaces places_of(const NpyArray& array);

/// One number of `type` at `bytes`.
double number_at(const char* bytes, const NpyType& type);

/// Whether a number can be said in a type, after rounding to a whole one for integers.
bool fits(double number, const NpyType& type);

/// Writes a number that fits at `bytes`: rounded to the nearest one of the type.
void put_number(double number, const NpyType& type, char* bytes);

/// The texts of an array of text, in the order of C, as UTF-8, without trailing zeros.
std::vector<std::string> texts_of(const NpyArray& array);

/// What stands before the items of a C-ordered array, as NumPy writes it.
std::string npy_head(const NpyType& type, const std::vector<std::uint64_t>& shape);

}  // namespace moclean
