#include "moclean/experiment/toml_file.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "moclean/formats/file.hpp"
#include "moclean/formats/text_scanner.hpp"

namespace moclean {
namespace {

class AssertionOfToml : public Error {
 public:
  AssertionOfToml() : Error("toml++ asserts") {}
};

bool is_parsed(std::string_view text) {
  try {
    static_cast<void>(toml::parse(text));
    return true;
  } catch (const AssertionOfToml&) {
    return false;
  }
}

// Moves behind a text in quotes that begins at `at`, or to where it breaks off.
std::size_t behind_quoted(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string_view three = quote == '"' ? "\"\"\"" : "'''";
  const bool is_long = text.substr(at, 3) == three;
  const std::string_view end = is_long ? three : three.substr(0, 1);
  for (at += end.size(); at < text.size(); ++at) {
    if (text[at] == '\n' && !is_long) return at;
    if (text[at] == '\\' && quote == '"') {
      ++at;
    } else if (text.substr(at, end.size()) == end) {
      at += end.size();
      for (int more = 0; is_long && more < 2 && at < text.size() && text[at] == quote; ++more) ++at;
      return at;
    }
  }
  return text.size();
}

// TOML has letters of other alphabets in quotes and comments only. Elsewhere toml++ asks of some
// whether they are blanks in a way that C++ does not define.
void require_plain_keys(std::string_view text, const std::filesystem::path& file) {
  std::size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  while (at < text.size()) {
    const char c = text[at];
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
    } else if (c == '"' || c == '\'') {
      at = behind_quoted(text, at);
    } else if (static_cast<unsigned char>(c) < 0x80) {
      ++at;
    } else {
      const auto line =
          std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
      const std::size_t end = std::min(text.find_first_of(" \t\r\n=]", at), text.size());
      throw FileError(file, static_cast<std::size_t>(line) + 1,
                      "expected letters of ASCII outside of quotes, found " +
                          excerpt(text.substr(at, end - at)));
    }
  }
}

// The first line with which the text cannot be parsed: the parser reads from the beginning.
std::size_t line_of_failure(std::string_view text) {
  std::vector<std::size_t> ends;  // of the lines
  for (std::size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + 1))
    ends.push_back(at + 1);
  const auto first = std::partition_point(
      ends.begin(), ends.end(), [&](std::size_t end) { return is_parsed(text.substr(0, end)); });
  return static_cast<std::size_t>(first - ends.begin()) + 1;
}

}  // namespace

void fail_assertion_of_toml() { throw AssertionOfToml(); }

toml::table read_toml(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  require_plain_keys(text, file);
  try {
    toml::parse_result result = toml::parse(text, file.string());
    if (!result)
      throw FileError(file, result.error().source().begin.line,
                      std::string(result.error().description()));
    return std::move(result).table();
  } catch (const AssertionOfToml&) {
    throw FileError(file, line_of_failure(text), "expected TOML: key = value, [table]");
  }
}

}  // namespace moclean
