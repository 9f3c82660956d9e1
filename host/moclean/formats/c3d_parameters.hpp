#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "moclean/formats/c3d_numbers.hpp"

namespace moclean {

/// A group or a parameter of a C3D file, byte for byte.
struct C3dRecord {
  int group = 0;        ///< negative for the group itself
  bool locked = false;  ///< the file says that programs should leave it
  std::string name;     ///< in whatever case
  std::string body;     ///< all that follows the offset to the next record
};

/// Where in the body of a record the value of a parameter lies.
struct C3dValue {
  int type = 0;                      ///< -1 text, 1 bytes, 2 integers, 4 reals
  std::vector<std::size_t> extents;  ///< the first runs fastest; none: one element
  std::size_t at = 0;                ///< first byte
  std::size_t count = 0;             ///< elements
};

/// The parameter section of a C3D file (c3d.org, "The parameter section"). Groups and parameters
/// are found by name in any case, and keep their order. A parameter that does not exist, has
/// another type or does not fit into its record reads as one without elements.
class C3dParameters {
 public:
  explicit C3dParameters(C3dNumbers numbers) : numbers_(numbers) {}

  /// Reads the records from byte `at` of a file's content on, up to the one that says that it is
  /// the last or the end of them. Throws FileError naming the byte.
  C3dParameters(std::string_view content, std::size_t at, C3dNumbers numbers,
                const std::filesystem::path& file);

  bool has_group(std::string_view group) const { return id_of(group) != 0; }

  std::vector<double> numbers(std::string_view group, std::string_view name) const;
  std::vector<unsigned> words(std::string_view group, std::string_view name) const;

  /// Texts without the blanks and zeros behind them. NAME, NAME2, NAME3 ... together: a parameter
  /// has room for 255.
  std::vector<std::string> texts(std::string_view group, std::string_view name) const;
  std::string text(std::string_view group, std::string_view name) const;  ///< the first

  /// Overwrites the first elements of integers or reals; without effect beyond those there are.
  void set(std::string_view group, std::string_view name, const std::vector<double>& values);

  /// False, without effect, if no number is left for a group or one of that name exists.
  bool add_group(std::string_view group, std::string_view description);
  void remove_group(std::string_view group);

  void add(std::string_view group, std::string_view name, int type,
           const std::vector<std::size_t>& extents, std::string_view data);
  void add_word(std::string_view group, std::string_view name, unsigned value);
  void add_words(std::string_view group, std::string_view name,
                 const std::vector<unsigned>& values);
  void add_real(std::string_view group, std::string_view name, double value);
  void add_text(std::string_view group, std::string_view name, std::string_view text);

  /// As NAME, NAME2 ...: as many of each as a parameter has room for.
  void add_texts(std::string_view group, std::string_view name,
                 const std::vector<std::string>& texts);
  void add_reals(std::string_view group, std::string_view name, const std::vector<double>& values);

  /// The records as the file has them, with the end behind them.
  std::string bytes() const;

 private:
  int id_of(std::string_view group) const;  // 0: there is none
  const C3dRecord* find(std::string_view group, std::string_view name) const;
  C3dRecord* find(std::string_view group, std::string_view name);
  std::string series_name(std::string_view name, std::size_t number) const;

  C3dNumbers numbers_;
  std::vector<C3dRecord> records_;
};

}  // namespace moclean
