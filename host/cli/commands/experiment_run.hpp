#pragma once

#include "cli/commands/commands.hpp"
#include "cli/options/experiment_options.hpp"

namespace moclean::cli {

/// `moclean experiment table2|table3`.
ExitCode run_table(TableOptions options);

/// `moclean experiment grid`.
ExitCode run_grid(GridOptions options);

/// Warns on standard error if segments did not converge, and says so by the exit code.
ExitCode warn_of_unconverged(Index segments);

}  // namespace moclean::cli
