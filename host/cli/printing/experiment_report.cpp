#include "cli/printing/experiment_report.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "moclean/formats/file.hpp"

namespace moclean::cli {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

std::string take_title(const ExperimentTake& take, const PaperPart& part) {
  const std::string whose =
      part.sequence ? fmt::format(" (the paper's {})", part.sequence->name) : "";
  return fmt::format("{}{}: {} frames, {} of them noisy", take.label, whose, take.clip.frames(),
                     part.noisy_frames);
}

// Frames per second of the cells of one method and noise; nothing where no time was taken.
double speed(std::span<const Cell> cells, std::span<const CellResult> results, std::size_t method,
             std::size_t noise) {
  double frames = 0, seconds = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].method != method || cells[i].noise != noise) continue;
    if (!results[i].refused.empty()) continue;
    frames += static_cast<double>(results[i].frames);
    seconds += results[i].figure("seconds");
  }
  return seconds > 0 ? std::round(frames / seconds) : no_number;
}

struct Column {
  const char* head;
  const char* figure;
};

constexpr std::array shown = {
    Column{"RMSE touched", "rmse_touched"}, Column{"RMSE untouched", "rmse_untouched"},
    Column{"position error", "position"}, Column{"smoothness error", "smoothness"},
    Column{"missing", "missing"}};

ReportTable noise_table(const Experiment& experiment, std::span<const Cell> cells,
                        std::span<const CellResult> results, std::span<const Standing> standings,
                        std::size_t noise) {
  ReportTable table{.title = fmt::format("Noise: {}", experiment.noises[noise].label),
                    .note = fmt::format("{}. Means over takes and seeds; missing is the share of "
                                        "samples a method leaves out of all figures.",
                                        to_string(experiment.noises[noise].noise)),
                    .columns = {"method", "FD", "FD sd"},
                    .rows = {}};
  for (const Column& column : shown) table.columns.emplace_back(column.head);
  table.columns.emplace_back("frames/s");
  for (const Standing& standing : standings) {
    const std::size_t method = standing.method;
    std::vector<ReportTable::Cell> row = {experiment.methods[method].label, standing.fd[noise].mean,
                                          standing.fd[noise].sd};
    for (const Column& column : shown)
      row.emplace_back(spread_of(cells, results, column.figure, [&](const Cell& cell) {
                         return cell.method == method && cell.noise == noise;
                       }).mean);
    row.emplace_back(speed(cells, results, method, noise));
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportTable take_table(const Experiment& experiment, std::span<const Cell> cells,
                       std::span<const CellResult> results, std::span<const Standing> standings,
                       std::size_t take) {
  const ExperimentTake& own = experiment.takes[take];
  ReportTable table{.title = fmt::format("Take: {}", own.label),
                    .note = fmt::format("FD, mean over seeds. {} frames x {} columns{}.",
                                        own.clip.frames(), own.clip.samples.cols(),
                                        own.clip.unit.empty() ? "" : ", in " + own.clip.unit),
                    .columns = {"method"},
                    .rows = {}};
  for (const ExperimentNoise& noise : experiment.noises) table.columns.push_back(noise.label);
  for (const Standing& standing : standings) {
    std::vector<ReportTable::Cell> row = {experiment.methods[standing.method].label};
    for (std::size_t n = 0; n < experiment.noises.size(); ++n)
      row.emplace_back(spread_of(cells, results, "fd", [&](const Cell& cell) {
                         return cell.method == standing.method && cell.noise == n &&
                                cell.take == take;
                       }).mean);
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

const char* const svt_rule =
    "svt subtracts tau from the singular values, tau = (1 + sqrt(beta)) / sqrt(mu) times their "
    "median, the edge of white noise (docs/methods.md); the paper states no rule.";

std::vector<ReportTable> paper_report_tables(PaperTable table, const PaperExperiment& paper,
                                             std::span<const CellResult> results) {
  std::vector<ReportTable> tables;
  for (std::size_t t = 0; t < paper.parts.size(); ++t) {
    const PaperPart& part = paper.parts[t];
    ReportTable own{.title = take_title(paper.experiment.takes[t], part),
                    .note = table == PaperTable::methods ? svt_rule : "",
                    .columns = {table == PaperTable::methods ? "method" : "frames per segment",
                                "FD", "sd", "paper", "FD / paper"},
                    .rows = {}};
    for (const PaperRow& row : part.rows) {
      const Spread fd = spread_of(paper.cells, results, "fd", [&](const Cell& cell) {
        return cell.take == t && cell.method == row.method;
      });
      own.rows.push_back({row.label, fd.mean, fd.sd, row.printed.value_or(no_number),
                          row.printed ? fd.mean / *row.printed : no_number});
    }
    tables.push_back(std::move(own));
  }
  return tables;
}

ReportTable ranking_table(const Experiment& experiment, std::span<const Standing> standings) {
  ReportTable table{.title = "Ranking",
                    .note = fmt::format(
                        "Mean place by FD over {} takes and {} noises, {} seeds each; then FD per "
                        "noise. Who refuses a take or leaves samples missing comes last there.",
                        experiment.takes.size(), experiment.noises.size(), experiment.seeds.size()),
                    .columns = {"method", "place", "first"},
                    .rows = {}};
  for (const ExperimentNoise& noise : experiment.noises) table.columns.push_back(noise.label);
  table.columns.insert(table.columns.end(), {"incomplete", "frames/s"});
  for (const Standing& standing : standings) {
    std::vector<ReportTable::Cell> row = {experiment.methods[standing.method].label,
                                          standing.mean_rank, static_cast<double>(standing.wins)};
    for (const Spread& fd : standing.fd) row.emplace_back(fd.mean);
    row.emplace_back(static_cast<double>(standing.incomplete));
    row.emplace_back(std::isfinite(standing.frames_per_second)
                         ? std::round(standing.frames_per_second)
                         : no_number);
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<ReportTable> grid_report_tables(const Experiment& experiment,
                                            std::span<const Cell> cells,
                                            std::span<const CellResult> results,
                                            std::span<const Standing> standings) {
  std::vector<ReportTable> tables = {ranking_table(experiment, standings)};
  for (std::size_t n = 0; n < experiment.noises.size(); ++n)
    tables.push_back(noise_table(experiment, cells, results, standings, n));
  for (std::size_t t = 0; t < experiment.takes.size(); ++t)
    tables.push_back(take_table(experiment, cells, results, standings, t));
  return tables;
}

void write_report(const std::filesystem::path& file, const Report& report) {
  const std::string page = html(report);
  AtomicFile target(file);
  target.write(page);
  target.commit();
}

}  // namespace moclean::cli
