#include "cli/nearest.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace moclean::cli {
namespace {

char small_letter(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // rows[i % 3][j]: distance of the first i letters of a from the first j of b
  std::vector<std::size_t> rows[3];
  for (auto& row : rows) row.resize(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) rows[0][j] = j;
  const auto same = [&](std::size_t i, std::size_t j) {
    return small_letter(a[i - 1]) == small_letter(b[j - 1]);
  };
  for (std::size_t i = 1; i <= a.size(); ++i) {
    auto &row = rows[i % 3], &above = rows[(i + 2) % 3];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same(i, j) ? 0u : 1u)});
      if (i > 1 && j > 1 && same(i, j - 1) && same(i - 1, j))
        row[j] = std::min(row[j], rows[(i + 1) % 3][j - 2] + 1);
    }
  }
  return rows[a.size() % 3][b.size()];
}

std::string did_you_mean(std::string_view text, std::span<const std::string> names) {
  constexpr std::size_t longest = 64;  // beyond it is no name, and the table would be large
  if (text.size() > longest) return "";
  const std::string* nearest = nullptr;
  std::size_t least = 0;
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(text, name);
    if (distance > std::max<std::size_t>(1, std::max(text.size(), name.size()) / 3)) continue;
    if (nearest && distance >= least) continue;
    nearest = &name;
    least = distance;
  }
  return nearest ? fmt::format("; did you mean '{}'?", *nearest) : "";
}

}  // namespace moclean::cli
