#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace moclean::cli {

/// What the program returns; scripts depend on the numbers.
enum class ExitCode {
  done = 0,
  failed = 1,         ///< a take or the device failed, or --verify found a difference
  usage = 2,          ///< the command line is wrong; nothing was written
  not_converged = 3,  ///< everything is written, but a segment reached --max-iterations
  interrupted = 130   ///< SIGINT (Ctrl-C), SIGTERM, SIGHUP, SIGQUIT or SIGXCPU
};

/// What the chosen command does once the command line is parsed.
using Action = std::function<ExitCode()>;

/// Each adds one command to the program; if the user chooses it, parsing sets `action`.
void add_denoise(CLI::App& program, Action& action);
void add_corrupt(CLI::App& program, Action& action);
void add_evaluate(CLI::App& program, Action& action);
void add_convert(CLI::App& program, Action& action);
void add_info(CLI::App& program, Action& action);
void add_devices(CLI::App& program, Action& action);
void add_experiment(CLI::App& program, Action& action);
void add_tune(CLI::App& program, Action& action);

}  // namespace moclean::cli
