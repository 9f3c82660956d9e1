#include "moclean/experiment/toml_file.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "moclean/formats/file.hpp"

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
