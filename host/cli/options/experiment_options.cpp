#include "cli/options/experiment_options.hpp"

#include <CLI/CLI.hpp>

#include "moclean/backend/opencl_backend.hpp"

#include "cli/options/checks.hpp"
#include "cli/options/input_options.hpp"

namespace moclean::cli {
namespace {

void add_common(CLI::App& command, ExperimentOptions& options) {
  command.add_option("--json", options.json, "Write the figures as JSON; - is standard output")
      ->type_name("FILE");
  command.add_option("--report", options.report, "Write an HTML page of the tables")
      ->type_name("FILE.html");
  command.add_flag("--quiet", options.quiet, "Print nothing but warnings and errors");
  add_backend_options(command, options);
}

}  // namespace

void add_table_options(CLI::App& command, TableOptions& options) {
  command
      .add_option("TAKE", options.inputs,
                  with_extensions("Recordings without noise", can_read) + ", or folders of them")
      ->required()
      ->type_name("");
  command.add_option("--seeds", options.seeds, "So many noises per take, of seeds 1 to N")
      ->check(whole_number(1, 1'000'000))
      ->default_val(5)
      ->type_name("N");
  add_frames_option(command, options.frames,
                    "Use frames A up to B - 1 of every take; default: the paper's of its own "
                    "takes, all of others");
  add_file_options(command, options.rate, options.skeleton);
  add_common(command, options);
}

void add_grid_options(CLI::App& command, GridOptions& options) {
  command.add_option("CONFIG", options.config, "Grid file (.toml)")->required()->type_name("");
  command
      .add_option("-o,--output", options.output,
                  "Folder for cells.jsonl, cells.csv, summary.json and report.html, made if "
                  "missing; default: out/NAME of NAME.toml. What is finished there is not computed "
                  "again")
      ->type_name("FOLDER");
  command.add_option("--seeds", options.seeds, "Seeds 1 to N instead of those of the grid file")
      ->check(whole_number(1, 1'000'000))
      ->type_name("N");
  add_frames_option(command, options.frames, "Use frames A up to B - 1 of takes that state none");
  add_common(command, options);
}

RobustPca robust_pca_defaults(const BackendOptions& options) {
  RobustPca defaults;
  if (options.precision == Precision::mixed) defaults.tolerance = mixed_tolerance;
  return defaults;
}

}  // namespace moclean::cli
