#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include "moclean/core/version.hpp"
#include "moclean/experiment/run_cells.hpp"
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

struct Takes {
  std::vector<ExperimentTake> takes;
  std::vector<bool> is_papers;  // cut as the paper cuts it
};

Takes read_takes(const TableOptions& options) {
  Takes result;
  for (const fs::path& file : expand_folders(options.inputs)) {
    const ReadOptions reading{
        .skeleton = options.skeleton, .rate = options.rate, .frames = options.frames};
    Recording truth = read_recording(file, reading);
    require_solvable(truth, file, reading.frames);
    ExperimentTake take{.name = file.stem().string(),
                        .label = file.filename().string(),
                        .file = file,
                        .clip = like(truth, std::move(truth.samples)),  // every cell copies it
                        .excluded = {}};
    const bool all = !options.frames.first && !options.frames.last;
    const PaperSequence* sequence = all ? find_sequence(take.name) : nullptr;
    const bool is_papers = sequence && take.clip.frames() >= sequence->frames;
    if (is_papers) take.clip = excerpt(take.clip, 0, sequence->frames);
    result.takes.push_back(std::move(take));
    result.is_papers.push_back(is_papers);
  }
  return result;
}

std::vector<std::uint64_t> seeds_up_to(int count) {
  std::vector<std::uint64_t> seeds;
  for (int seed = 1; seed <= count; ++seed) seeds.push_back(static_cast<std::uint64_t>(seed));
  return seeds;
}

const char* title_of(PaperTable table) {
  return table == PaperTable::methods ? "Table 2 of Peng et al.: FD of four methods"
                                      : "Table 3 of Peng et al.: FD against frames per segment";
}

Json row_record(const PaperExperiment& paper, std::span<const CellResult> results, std::size_t take,
                const PaperRow& row) {
  Json record = {{"label", row.label}, {"method", paper.experiment.methods[row.method].label}};
  const auto own = [&](const Cell& cell) { return cell.take == take && cell.method == row.method; };
  const Spread fd = spread_of(paper.cells, results, "fd", own);
  record["fd"] = {{"mean", fd.mean}, {"sd", fd.sd}, {"values", Json::array()}};
  for (std::size_t i = 0; i < results.size(); ++i)
    if (own(paper.cells[i])) record["fd"]["values"].push_back(results[i].figure("fd"));
  record["paper"] = row.printed ? Json(*row.printed) : Json(nullptr);
  return record;
}

Json table_record(const TableOptions& options, const std::string& device,
                  const PaperExperiment& paper, std::span<const CellResult> results) {
  Json record = {{"version", version()},
                 {"device", device},
                 {"precision", to_string(options.precision)},
                 {"table", static_cast<int>(options.table)},
                 {"seeds", paper.experiment.seeds},
                 {"takes", Json::array()}};
  for (std::size_t t = 0; t < paper.parts.size(); ++t) {
    const ExperimentTake& take = paper.experiment.takes[t];
    const PaperPart& part = paper.parts[t];
    Json own = {{"file", take.file.string()},
                {"frames", take.clip.frames()},
                {"columns", take.clip.samples.cols()},
                {"sequence", part.sequence ? Json(part.sequence->name) : Json(nullptr)},
                {"noise", paper.experiment.noises[t].label},
                {"rows", Json::array()}};
    for (const PaperRow& row : part.rows) own["rows"].push_back(row_record(paper, results, t, row));
    record["takes"].push_back(std::move(own));
  }
  return record;
}

Report table_report(const TableOptions& options, const std::string& device,
                    std::vector<ReportTable> tables) {
  return {.title = title_of(options.table),
          .tables = std::move(tables),
          .parameters = {{"noise",
                          "Gaussian(1, 1.2) on half of the entries of the noisy frames "
                          "(equation 7)"},
                         {"seeds", fmt::format("1 to {}; FD is their mean, sd their standard "
                                               "deviation",
                                               options.seeds)},
                         {"computed on", device},
                         {"precision", to_string(options.precision)},
                         {"moclean", std::string(version())}}};
}

}  // namespace

ExitCode warn_of_unconverged(Index segments) {
  if (segments == 0) return ExitCode::done;
  warn("{} segments did not converge", segments);
  return ExitCode::not_converged;
}

ExitCode run_table(TableOptions options) {
  complete_backend(options);
  if (options.backend == "opencl") require_driver();
  if (!options.report.empty()) require_report();
  if (!options.report.empty()) require_writable(options.report);
  if (!options.json.empty() && options.json != "-") require_writable(options.json);
  const NamedFile records[] = {{"--json", options.json}, {"--report", options.report}};
  std::vector<NamedFile> read = {{"--skeleton", options.skeleton}};
  for (const fs::path& file : expand_folders(options.inputs)) read.push_back({"TAKE", file});
  require_apart(read, records);
  auto [takes, is_papers] = read_takes(options);
  const PaperExperiment paper =
      paper_experiment(options.table, std::move(takes), is_papers, seeds_up_to(options.seeds),
                       robust_pca_defaults(options));

  const OpenedBackend opened = open_backend(options, true);
  std::vector<CellResult> results;
  {
    const Interrupt interrupt;
    ProgressLine line("computing", options.prints(), "cells");
    results =
        run_cells(paper.experiment, paper.cells,
                  {.backend = opened.backend.get(),
                   .jobs = options.jobs,
                   .memory = options.memory_limit / 2,
                   .monitor = {.report = [&](const Progress& progress) { line.show(progress); },
                               .stop = interrupt.token()}});
  }

  const auto tables = paper_report_tables(options.table, paper, results);
  if (options.prints()) {
    say("{}, mean and standard deviation over {} seeds\n", title_of(options.table), options.seeds);
    for (const ReportTable& table : tables) say("\n{}", Lines{markdown_table(table)});
  }
  if (!options.json.empty())
    write_json(options.json, table_record(options, opened.report.name, paper, results));
  if (!options.report.empty())
    write_report(options.report, table_report(options, opened.report.name, tables));
  Index unconverged = 0;
  for (const CellResult& result : results) unconverged += result.unconverged;
  return warn_of_unconverged(unconverged);
}

}  // namespace moclean::cli
