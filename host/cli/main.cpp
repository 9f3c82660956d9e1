// The program `moclean`. Reads the command line, runs one command, and turns every exception into a
// message and an exit code.

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "moclean/core/error.hpp"
#include "moclean/core/version.hpp"
#include "moclean/formats/unfinished.hpp"

#include "cli/commands/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/nearest.hpp"
#include "cli/printing/say.hpp"
#include "cli/printing/standard_output.hpp"

namespace moclean::cli {
namespace {

ExitCode fail(ExitCode code, const std::string& message) {
  warn("{}", message);
  return code;
}

// A descriptor that is closed would be that of the next file that is opened, and what is printed
// would go into it. Opened for the other direction, it is an error to use it.
void open_standard_streams() {
  for (const auto& [stream, mode] :
       {std::pair{STDIN_FILENO, O_WRONLY}, {STDOUT_FILENO, O_RDONLY}, {STDERR_FILENO, O_RDONLY}})
    if (fcntl(stream, F_GETFD) < 0) open("/dev/null", mode);  // gets the lowest number
}

// Where an exception may not pass: no memory in a function of others, say, that promises to throw
// nothing. CLBlast 1.5.3 does where the device has none.
[[noreturn]] void end_at_once() {
  static std::atomic<bool> ending = false;
  if (!ending.exchange(true)) remove_unfinished();  // which may lead here again
  constexpr std::string_view message =
      "moclean: cannot go on, there is not enough memory of the machine or, for CLBlast, of the "
      "device\n";
  [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, message.data(), message.size());
  _exit(static_cast<int>(ExitCode::failed));
}

// A library may end the process by exit(): LLVM does in an OpenCL driver that cannot write its
// files.
bool returns_from_main = false;
const pid_t process = getpid();

void explain_exit() {
  if (returns_from_main || getpid() != process) return;  // that of a child is not our end
  remove_unfinished();
  std::fputs("moclean: ended by a library, most likely the OpenCL driver, for the reason above\n",
             stderr);
}

// Whoever reads from a pipe may have enough and go: no word then, as everywhere.
ExitCode with_output_sent(ExitCode code) {
  const int error = output_failure();
  if (error == 0) return code;
  if (error == EPIPE) {
    std::signal(SIGPIPE, SIG_DFL);
    std::raise(SIGPIPE);
  }
  warn("standard output: cannot be written: {}", std::generic_category().message(error));
  return code == ExitCode::done ? ExitCode::failed : code;
}

// With the command that was given, or the program alone if none was recognised.
std::string command_name(const CLI::App& program) {
  const auto chosen = program.get_subcommands();
  return chosen.empty() ? "moclean" : fmt::format("moclean {}", chosen[0]->get_name());
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
    if (argument == "--") break;  // names of files follow
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
    return fail(ExitCode::usage,
                fmt::format("{} (see {} --help)",
                            problem(program, {arguments + 1, arguments + count}, error),
                            command_name(program)));
  } catch (const ArgumentError& error) {
    return fail(ExitCode::usage, error.what());
  } catch (const Cancelled&) {
    return fail(ExitCode::interrupted, "interrupted; nothing was written");
  } catch (const FileError& error) {
    return fail(ExitCode::failed, error.what());
  } catch (const Error& error) {  // of a build log, or several takes
    warn("{}", Lines{error.what()});
    return ExitCode::failed;
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::failed,
                fmt::format("{}: there is not enough memory", command_name(program)));
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(ExitCode::failed,
                fmt::format("{}: {}", error.path1().string(), error.code().message()));
  } catch (const std::exception& error) {
    return fail(ExitCode::failed, error.what());
  }
}

}  // namespace
}  // namespace moclean::cli

int main(int count, char** arguments) {
  using namespace moclean::cli;
  open_standard_streams();
  std::set_terminate(end_at_once);
  std::atexit(explain_exit);
  try {
    const SignalWatch signals;  // before the threads of the OpenCL driver
    const ExitCode code = with_output_sent(run_program(count, arguments));
    moclean::remove_unfinished();  // the folder of the driver's kernels, if they had to have one
    returns_from_main = true;
    return static_cast<int>(code);
  } catch (const std::exception&) {  // a thread that cannot be made, no memory for a message
    std::fputs("moclean: there is not enough memory\n", stderr);
    returns_from_main = true;
    return static_cast<int>(ExitCode::failed);
  }
}
