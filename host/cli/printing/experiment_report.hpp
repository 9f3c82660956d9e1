#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "moclean/experiment/paper_tables.hpp"
#include "moclean/experiment/summary.hpp"
#include "moclean/report/report.hpp"

namespace moclean::cli {

/// One table per take: FD of every row, mean and standard deviation over the seeds, the paper's.
std::vector<ReportTable> paper_report_tables(PaperTable table, const PaperExperiment& paper,
                                             std::span<const CellResult> results);

/// How svt of Table 2 gets its threshold.
extern const char* const svt_rule;

/// The methods of a grid, best first.
ReportTable ranking_table(const Experiment& experiment, std::span<const Standing> standings);

/// The figures of a grid: the ranking, then one table per noise, then one per take.
std::vector<ReportTable> grid_report_tables(const Experiment& experiment,
                                            std::span<const Cell> cells,
                                            std::span<const CellResult> results,
                                            std::span<const Standing> standings);

/// Writes a report, complete or not at all. Throws as html(), and FileError.
void write_report(const std::filesystem::path& file, const Report& report);

}  // namespace moclean::cli
