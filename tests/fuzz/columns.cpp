#include <algorithm>
#include <array>
#include <string>

#include "moclean/formats/csv.hpp"

#include "fuzz/recordings.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

void columns(std::string_view input) {
  constexpr std::array<std::string_view, 4> layouts = {"automatic", "points3", "points2", "plain"};
  const std::size_t end = std::min(input.find('\n'), input.size());
  const std::string_view line = input.substr(0, end);
  ReadOptions options;
  if (const auto layout = std::ranges::find(layouts, line); layout != layouts.end())
    options.layout = static_cast<ColumnLayout>(layout - layouts.begin());
  else
    options.columns = line;
  input.remove_prefix(std::min(end + 1, input.size()));
  read_and_write({.format = csv_format, .read = csv_format.read, .guesses_columns = true}, input,
                 options);
}

}  // namespace moclean::fuzz
