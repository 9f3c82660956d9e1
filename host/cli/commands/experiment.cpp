#include <memory>

#include <CLI/CLI.hpp>

#include "cli/commands/commands.hpp"
#include "cli/commands/experiment_run.hpp"

namespace moclean::cli {
namespace {

void add_table(CLI::App& experiment, Action& action, PaperTable table, const char* name,
               const char* description) {
  CLI::App& command = *experiment.add_subcommand(name, description);
  command.footer(
      "Takes named like the paper's are cut as there: 14_46 (1200 frames, 400 noisy), 13_27 "
      "(2000,\n"
      "700), 14_06 (2800, 900). Of others all frames are used, a third of them noisy.\n\n"
      "Example:\n"
      "  moclean experiment table3 14_06.amc walk.bvh --seeds 10 --report table3.html");
  const auto options = std::make_shared<TableOptions>();
  options->table = table;
  add_table_options(command, *options);
  command.callback([&action, options] { action = [options] { return run_table(*options); }; });
}

void add_grid(CLI::App& experiment, Action& action) {
  CLI::App& command = *experiment.add_subcommand("grid", "Takes x noises x methods x seeds");
  command.footer(
      "docs/experiment.md has the keys of the grid file. A run that was killed continues where it\n"
      "was; what a changed grid file leaves as it was is not computed again.\n\n"
      "Example:\n"
      "  moclean experiment grid bench/ranking.toml -o out/ranking");
  const auto options = std::make_shared<GridOptions>();
  add_grid_options(command, *options);
  command.callback([&action, options] { action = [options] { return run_grid(*options); }; });
}

}  // namespace

void add_experiment(CLI::App& program, Action& action) {
  CLI::App& command = *program.add_subcommand("experiment", "Compare methods on spoilt recordings");
  command.require_subcommand(1);
  add_table(command, action, PaperTable::methods, "table2",
            "Table 2 of Peng et al.: slra, tsvd, svt and rpca");
  add_table(command, action, PaperTable::segment_lengths, "table3",
            "Table 3 of Peng et al.: FD against the length of segments");
  add_grid(command, action);
}

}  // namespace moclean::cli
