#include "moclean/formats/table_number.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <string>

#include "moclean/formats/plain_number.hpp"

namespace moclean {
namespace {

char lower_case(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool is_microsofts_nan(std::string_view word) {
  if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
  for (const std::string_view known : {"1.#ind", "1.#qnan", "1.#snan"})
    if (word.starts_with(known))
      return word.find_first_not_of('0', known.size()) == std::string_view::npos;
  return false;
}

bool parsed(std::string_view text, double& value) {
  const char* const last = text.data() + text.size();
  if (plain_number(text.data(), last, value) == last) return true;
  const auto [after, error] = std::from_chars(text.data(), last, value);
  return error == std::errc() && after == last;
}

}  // namespace

bool table_number(std::string_view text, char decimal, double& value) {
  constexpr std::size_t longest = 400;  // of a double written out without an exponent, and more
  if (text.empty()) return false;
  if (text[0] == '+' && !text.starts_with("+-")) text.remove_prefix(1);
  if (decimal == '.' || text.find(',') == std::string_view::npos)
    return (decimal == '.' || text.find('.') == std::string_view::npos) && parsed(text, value);
  if (text.size() > longest || text.find('.') != std::string_view::npos) return false;
  std::array<char, longest> copy;  // of which only what is written is read
  std::replace_copy(text.begin(), text.end(), copy.begin(), ',', '.');
  return parsed({copy.data(), text.size()}, value);
}

bool says_missing(std::string_view text) {
  constexpr std::size_t longest = 32;
  if (text.empty()) return true;
  if (text.size() > longest) return false;
  std::string word(text);
  std::transform(word.begin(), word.end(), word.begin(), lower_case);
  for (const char* known :
       {"nan",       "na",      "n/a",     "#n/a",    "<na>",  "n.a.",  "null",
        "none",      "missing", "-",       "--",      ".",     "-nan",  "nan(ind)",
        "-nan(ind)", "#num!",   "#div/0!", "#value!", "#ref!", "#name?"})
    if (word == known) return true;
  return is_microsofts_nan(word);
}

bool has_decimal(std::string_view text, char decimal) {
  double value = 0;
  return text.find(decimal) != std::string_view::npos && table_number(text, decimal, value);
}

}  // namespace moclean
