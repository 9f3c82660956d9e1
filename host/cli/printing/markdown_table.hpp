#pragma once

#include <string>

#include "moclean/report/report.hpp"

namespace moclean::cli {

/// A table of a report as text, aligned and valid Markdown: numbers to four digits, `-` for NaN.
/// Title and note stand above it.
std::string markdown_table(const ReportTable& table);

}  // namespace moclean::cli
