#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/version.hpp"
#include "moclean/experiment/grid_config.hpp"
#include "moclean/experiment/run_cells.hpp"
#include "moclean/experiment/summary.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/temporary_name.hpp"
#include "moclean/run/outputs.hpp"
#include "moclean/run/same_file.hpp"

#include "cli/backend/driver_check.hpp"
#include "cli/backend/open_backend.hpp"
#include "cli/commands/experiment_run.hpp"
#include "cli/interrupt.hpp"
#include "cli/printing/experiment_report.hpp"
#include "cli/printing/json_record.hpp"
#include "cli/printing/markdown_table.hpp"
#include "cli/printing/progress_line.hpp"
#include "cli/printing/say.hpp"

namespace moclean::cli {
namespace {

namespace fs = std::filesystem;

// A grid and everything known about it.
struct Grid {
  Experiment experiment = {};
  std::vector<fs::path> missing = {};  // takes that are not there
  std::vector<Cell> cells = {};
  std::string device = {};
  std::vector<CellResult> results = {};
  std::vector<Standing> standings = {};
};

Grid read(const GridOptions& options) {
  GridConfig config =
      read_grid(options.config, {.robust_pca = robust_pca_defaults(options), .segmentation = {}});
  GridTakes takes = read_takes(config, {options.frames.first, options.frames.last});
  Grid grid{.experiment = {.takes = std::move(takes.takes),
                           .noises = std::move(config.noises),
                           .methods = std::move(config.methods),
                           .seeds = std::move(config.seeds)},
            .missing = std::move(takes.missing)};
  if (options.seeds > 0) {
    grid.experiment.seeds.clear();
    for (int seed = 1; seed <= options.seeds; ++seed)
      grid.experiment.seeds.push_back(static_cast<std::uint64_t>(seed));
  }
  grid.cells = all_cells(grid.experiment);
  return grid;
}

bool any_needs_backend(const Experiment& experiment) {
  for (const ExperimentMethod& method : experiment.methods)
    if (!method.chain.empty() && needs_backend(method.chain)) return true;
  return false;
}

void compute(Grid& grid, const GridOptions& options, CellResults& kept) {
  const OpenedBackend opened = open_backend(options, any_needs_backend(grid.experiment));
  grid.device = opened.report.name;
  const Interrupt interrupt;
  ProgressLine line("computing", options.prints(), "cells");
  grid.results =
      run_cells(grid.experiment, grid.cells,
                {.backend = opened.backend.get(),
                 .program = fmt::format("moclean {}", version()),
                 .device = grid.device + ", " + to_string(options.precision),
                 .jobs = options.jobs,
                 .memory = options.memory_limit / 2,
                 .results = &kept,
                 .monitor = {.report = [&](const Progress& progress) { line.show(progress); },
                             .stop = interrupt.token()}});
  grid.standings = ranking(grid.experiment, grid.cells, grid.results);
}

Json spread_record(const Spread& spread) {
  return {{"mean", spread.mean}, {"sd", spread.sd}, {"count", spread.count}};  // NaN: null
}

// Mean and spread of every figure over the cells of a method and a noise, of one take or all.
Json group_record(const Grid& grid, std::size_t method, std::size_t noise,
                  std::optional<std::size_t> take) {
  Json record = {{"noise", grid.experiment.noises[noise].label},
                 {"method", grid.experiment.methods[method].label},
                 {"figures", Json::object()}};
  if (take) record["take"] = grid.experiment.takes[*take].label;
  const auto own = [&](const Cell& cell) {
    return cell.method == method && cell.noise == noise && (!take || cell.take == *take);
  };
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    if (!own(grid.cells[i])) continue;
    for (const auto& [name, value] : grid.results[i].figures)
      if (!record["figures"].contains(name))
        record["figures"][name] = spread_record(spread_of(grid.cells, grid.results, name, own));
  }
  return record;
}

Json axes_record(const Grid& grid) {
  Json record = {{"seeds", grid.experiment.seeds},
                 {"takes", Json::array()},
                 {"missing_takes", Json::array()},
                 {"noises", Json::array()},
                 {"methods", Json::array()}};
  for (const ExperimentTake& take : grid.experiment.takes)
    record["takes"].push_back({{"label", take.label},
                               {"file", take.file.string()},
                               {"frames", take.clip.frames()},
                               {"columns", take.clip.samples.cols()},
                               {"columns_exclude", take.excluded}});
  for (const fs::path& file : grid.missing) record["missing_takes"].push_back(file.string());
  for (const auto& [label, noise] : grid.experiment.noises)
    record["noises"].push_back({{"label", label}, {"spec", to_string(noise)}});
  for (const auto& [label, chain] : grid.experiment.methods)
    record["methods"].push_back(
        {{"label", label}, {"spec", chain.empty() ? "none" : to_string(chain)}});
  return record;
}

Json grid_record(const Grid& grid, const GridOptions& options) {
  Json record = {{"version", version()},
                 {"device", grid.device},
                 {"precision", to_string(options.precision)},
                 {"config", options.config.string()}};
  record.update(axes_record(grid));
  record["ranking"] = Json::array();
  for (const Standing& standing : grid.standings)
    record["ranking"].push_back({{"method", grid.experiment.methods[standing.method].label},
                                 {"mean_rank", standing.mean_rank},
                                 {"first", standing.wins},
                                 {"incomplete", standing.incomplete},
                                 {"frames_per_second", standing.frames_per_second}});
  record["by_noise"] = record["by_take"] = Json::array();
  for (const Standing& standing : grid.standings)
    for (std::size_t n = 0; n < grid.experiment.noises.size(); ++n) {
      record["by_noise"].push_back(group_record(grid, standing.method, n, std::nullopt));
      for (std::size_t t = 0; t < grid.experiment.takes.size(); ++t)
        record["by_take"].push_back(group_record(grid, standing.method, n, t));
    }
  return record;
}

Report grid_report(const Grid& grid, const GridOptions& options) {
  Report report{
      .title = options.config.stem().string(),
      .tables = grid_report_tables(grid.experiment, grid.cells, grid.results, grid.standings)};
  const auto add = [&](std::string name, std::string value) {
    report.parameters.emplace_back(std::move(name), std::move(value));
  };
  add("grid file", options.config.string());
  for (const ExperimentTake& take : grid.experiment.takes)
    add("take " + take.label, take.file.string());
  for (const fs::path& file : grid.missing) add("left out (not there)", file.string());
  for (const auto& [label, noise] : grid.experiment.noises) add("noise " + label, to_string(noise));
  for (const auto& [label, chain] : grid.experiment.methods)
    add("method " + label, chain.empty() ? "none" : to_string(chain));
  add("seeds", fmt::format("{}", fmt::join(grid.experiment.seeds, ", ")));
  add("computed on", grid.device);
  add("precision", to_string(options.precision));
  add("moclean", std::string(version()));
  return report;
}

void write_text(const fs::path& file, const std::string& text) {
  AtomicFile target(file);
  target.write(text);
  target.commit();
}

void write_results(const Grid& grid, const GridOptions& options) {
  write_text(options.output / "cells.csv", cells_csv(grid.experiment, grid.cells, grid.results));
  const Json record = grid_record(grid, options);
  write_json(options.output / "summary.json", record);
  if (!options.json.empty()) write_json(options.json, record);
  if (report_available())
    write_report(options.report.empty() ? options.output / "report.html" : options.report,
                 grid_report(grid, options));
  if (!options.prints()) return;
  say("{}\nThe files are in {}: cells.jsonl, cells.csv, summary.json{}.\n",
      Lines{markdown_table(ranking_table(grid.experiment, grid.standings))},
      options.output.string(), report_available() && options.report.empty() ? ", report.html" : "");
}

void prepare(GridOptions& options) {
  complete_backend(options);
  if (!options.report.empty()) require_report();
  if (!options.report.empty()) require_writable(options.report);
  if (!options.json.empty() && options.json != "-") require_writable(options.json);
  if (options.output.empty()) options.output = fs::path("out") / options.config.stem();
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError(folder, "cannot be made: " + error.message());
}

void require_files_apart(const Grid& grid, const GridOptions& options) {
  std::vector<NamedFile> read = {{"CONFIG", options.config}};
  for (const ExperimentTake& take : grid.experiment.takes)
    read.push_back({"the grid file", take.file});
  std::vector<NamedFile> written = {{"--json", options.json}, {"--report", options.report}};
  for (const char* name : {"cells.jsonl", "cells.csv", "summary.json", "report.html"})
    written.push_back({"-o", options.output / name});
  require_apart(read, written);
}

}  // namespace

ExitCode run_grid(GridOptions options) {
  prepare(options);
  if (options.backend == "opencl") require_driver();
  Grid grid = read(options);
  for (const fs::path& file : grid.missing)
    warn("{} is not there; this take is left out", file.string());
  make_folder(options.output);
  require_files_apart(grid, options);
  remove_left_in(options.output);
  CellResults kept(options.output / "cells.jsonl");
  try {
    compute(grid, options, kept);
  } catch (const Cancelled&) {
    warn("interrupted; finished cells are in {}, the same command continues", kept.file().string());
    return ExitCode::interrupted;
  }
  write_results(grid, options);
  Index unconverged = 0;
  for (const CellResult& result : grid.results) unconverged += result.unconverged;
  return warn_of_unconverged(unconverged);
}

}  // namespace moclean::cli
