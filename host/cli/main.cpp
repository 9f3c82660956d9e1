// The program `moclean`. Reads the command line, runs one command, and turns every exception into a
// message and an exit code.

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/version.hpp"

#include "cli/commands/commands.hpp"
#include "cli/nearest.hpp"
#include "cli/printing/say.hpp"

namespace moclean::cli {
namespace {

ExitCode fail(ExitCode code, std::string_view message) {
  warn("{}", message);
  return code;
}

// The command the user got wrong, or the program itself if no command was recognised.
std::string help_command(const CLI::App& program) {
  const auto chosen = program.get_subcommands();
  return chosen.empty() ? "moclean --help"
                        : fmt::format("moclean {} --help", chosen[0]->get_name());
}

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

// What CLI11 says is wrong, with a guess where a command or an option is one that does not exist.
std::string problem(const CLI::App& program, const std::vector<std::string>& arguments,
                    const CLI::ParseError& error) {
  const CLI::App* command = &program;
  for (const std::string& argument : arguments) {
    const std::string name = argument.substr(0, argument.find('='));
    const std::vector<std::string> commands = command_names(*command);
    if (std::ranges::find(commands, name) != commands.end()) {
      command = command->get_subcommand(name);
    } else if (name.starts_with("--")) {
      if (command->get_option_no_throw(name)) continue;
      return fmt::format("unknown option {}{}", name, did_you_mean(name, option_names(*command)));
    } else if (!commands.empty() && !name.starts_with('-')) {
      return fmt::format("unknown command {}{}", name, did_you_mean(name, commands));
    }
  }
  return error.what();
}

ExitCode run_program(int count, char** arguments) {
  CLI::App program("Cleans human motion-capture recordings on OpenCL devices.", "moclean");
  program.set_version_flag("--version", fmt::format("moclean {}", version()));
  program.require_subcommand(1);
  program.footer(
      "Exit codes: 0 done, 1 failed input or device, 2 usage, 3 a segment did not converge,\n"
      "130 interrupted.\n\n"
      "Example:\n  moclean denoise walk.bvh -o clean.csv");
  Action action;
  add_denoise(program, action);
  add_corrupt(program, action);
  add_evaluate(program, action);
  add_convert(program, action);
  add_info(program, action);
  add_devices(program, action);
  add_experiment(program, action);
  add_tune(program, action);

  try {
    program.parse(count, arguments);
    return action();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help and --version
      program.exit(error);
      return ExitCode::done;
    }
    return fail(
        ExitCode::usage,
        fmt::format("{} (see {})", problem(program, {arguments + 1, arguments + count}, error),
                    help_command(program)));
  } catch (const ArgumentError& error) {
    return fail(ExitCode::usage, error.what());
  } catch (const Cancelled&) {
    return fail(ExitCode::interrupted, "interrupted; nothing was written");
  } catch (const std::exception& error) {
    return fail(ExitCode::failed, error.what());
  }
}

}  // namespace
}  // namespace moclean::cli

int main(int count, char** arguments) {
  return static_cast<int>(moclean::cli::run_program(count, arguments));
}
