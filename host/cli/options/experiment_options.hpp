#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "moclean/experiment/paper_tables.hpp"
#include "moclean/run/inputs.hpp"

#include "cli/options/backend_options.hpp"

namespace CLI {
class App;
}

namespace moclean::cli {

/// What both forms of `moclean experiment` have.
struct ExperimentOptions : BackendOptions {
  int seeds = 0;                 ///< noises are seeded by 1 .. seeds; 0: not given
  FrameRange frames;             ///< part of the takes
  std::filesystem::path json;    ///< "-": standard output; empty: none
  std::filesystem::path report;  ///< HTML; empty: none
  bool quiet = false;

  bool prints() const { return !quiet && json != "-"; }  ///< whether standard output is for people
};

/// `moclean experiment table2|table3`.
struct TableOptions : ExperimentOptions {
  PaperTable table = PaperTable::methods;
  std::vector<std::filesystem::path> inputs;  ///< files and folders
  double rate = 0;                            ///< Hz; 0 where not given
  std::filesystem::path skeleton;
};

/// `moclean experiment grid`.
struct GridOptions : ExperimentOptions {
  std::filesystem::path config;
  std::filesystem::path output;  ///< folder; empty: out/ and the name of the config
};

void add_table_options(CLI::App& command, TableOptions& options);
void add_grid_options(CLI::App& command, GridOptions& options);

/// What methods leave open: the tolerance depends on the precision.
RobustPca robust_pca_defaults(const BackendOptions& options);

}  // namespace moclean::cli
