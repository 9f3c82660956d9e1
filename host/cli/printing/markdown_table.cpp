#include "cli/printing/markdown_table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "moclean/core/printable.hpp"

namespace moclean::cli {
namespace {

std::string text_of(const ReportTable::Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return printable_line(*text);
  const double number = std::get<double>(cell);
  if (std::isnan(number)) return "-";
  const bool whole = number == std::round(number) && std::abs(number) < 1e15;
  return whole ? fmt::format("{:.0f}", number) : fmt::format("{:.4g}", number);
}

// Numbers to the right, texts to the left.
bool is_number(const ReportTable& table, std::size_t column) {
  return !table.rows.empty() && std::ranges::any_of(table.rows, [&](const auto& row) {
    return std::holds_alternative<double>(row[column]);
  });
}

}  // namespace

std::string markdown_table(const ReportTable& table) {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    std::size_t width = std::max<std::size_t>(3, table.columns[c].size());
    for (const auto& row : table.rows) width = std::max(width, text_of(row[c]).size());
    widths.push_back(width);
  }
  const auto aligned = [&](std::size_t c, const std::string& text) {
    return is_number(table, c) ? fmt::format("| {:>{}} ", text, widths[c])
                               : fmt::format("| {:<{}} ", text, widths[c]);
  };
  std::string result = printable_line(table.title) + "\n";
  if (!table.note.empty()) result += table.note + "\n";
  result += '\n';
  for (std::size_t c = 0; c < widths.size(); ++c) result += aligned(c, table.columns[c]);
  result += "|\n";
  for (std::size_t c = 0; c < widths.size(); ++c)
    result += "| " + std::string(widths[c] - 1, '-') + (is_number(table, c) ? ": " : "- ");
  result += "|\n";
  for (const auto& row : table.rows) {
    for (std::size_t c = 0; c < widths.size(); ++c) result += aligned(c, text_of(row[c]));
    result += "|\n";
  }
  return result;
}

}  // namespace moclean::cli
