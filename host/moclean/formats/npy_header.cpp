#include "moclean/formats/npy_header.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/text_scanner.hpp"

namespace moclean {
namespace {

constexpr std::string_view known_types =
    "real numbers, integers or text ('<f8', '>f4', '<i4', ...)";

class HeaderParser {
 public:
  HeaderParser(std::string_view header, const std::filesystem::path& file)
      : file_(file), rest_(header) {}

  NpyArray parse() {
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
    return std::move(array_);
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
    if (next() == '[') {  // names and types of the fields of a structured array
      array_.type = {.order = '|', .kind = 'V', .size = 0};
      const std::size_t end = rest_.find(']');
      if (end == std::string_view::npos) fail("']'", rest_);
      rest_.remove_prefix(end + 1);
      return true;
    }
    const std::string_view type = text();
    if (type.size() < 2) fail("a type such as '<f8'", type);
    array_.type = {.order = type[0] == '|' ? '<' : type[0], .kind = type[1], .size = 0};
    const std::string_view digits = type.substr(2);
    std::from_chars(digits.data(), digits.data() + digits.size(), array_.type.size);
    if (array_.type.kind == 'U') array_.type.size *= 4;
    return true;
  }

  bool fortran_order() {
    next();
    for (const std::string_view word : {"True", "False"})
      if (rest_.substr(0, word.size()) == word) {
        rest_.remove_prefix(word.size());
        array_.fortran_order = word == "True";
        return true;
      }
    fail("True or False", rest_);
  }

  bool shape() {
    array_.shape.clear();
    expect('(');
    while (!accept(')')) {
      next();
      std::uint64_t extent = 0;
      const auto [after, error] =
          std::from_chars(rest_.data(), rest_.data() + rest_.size(), extent);
      if (error != std::errc()) fail("a number of frames or columns", rest_);
      rest_.remove_prefix(static_cast<std::size_t>(after - rest_.data()));
      array_.shape.push_back(extent);
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
  NpyArray array_;
};

}  // namespace

NpyArray parse_npy_header(std::string_view header, const std::filesystem::path& file) {
  return HeaderParser(header, file).parse();
}

}  // namespace moclean
