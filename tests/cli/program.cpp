#include "cli/program.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace moclean::test {
namespace {

namespace fs = std::filesystem;

int require(int result, const char* what) {
  if (result < 0) throw std::runtime_error(what);
  return result;
}

// A file without a name.
int anonymous_file() {
  std::string name = (fs::temp_directory_path() / "moclean-XXXXXX").string();
  const int file = require(mkstemp(name.data()), "mkstemp");
  unlink(name.c_str());
  return file;
}

std::string rewound_content(int file) {
  lseek(file, 0, SEEK_SET);
  std::string text;
  char chunk[4096];
  for (ssize_t count; (count = ::read(file, chunk, sizeof chunk)) > 0;)
    text.append(chunk, static_cast<std::size_t>(count));
  return text;
}

std::vector<std::string> environment(const Start& start) {
  std::vector<std::string> variables;
  for (char** variable = environ; *variable; ++variable)
    if (!std::string_view(*variable).starts_with("MOCLEAN_DEVICE=") &&
        !std::string_view(*variable).starts_with("XDG_CACHE_HOME="))
      variables.emplace_back(*variable);
  variables.push_back(
      "XDG_CACHE_HOME=" +
      (start.cache.empty() ? (fs::temp_directory_path() / "moclean-test").string() : start.cache));
  if (!start.device.empty()) variables.push_back("MOCLEAN_DEVICE=" + start.device);
  variables.insert(variables.end(), start.environment.begin(), start.environment.end());
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> result;
  for (std::string& string : strings) result.push_back(string.data());
  result.push_back(nullptr);
  return result;
}

// A program inherits which signals are ignored; tests must not depend on who runs them.
void set_signals(posix_spawnattr_t& attributes, const Start& start) {
  sigset_t set;
  sigemptyset(&set);
  posix_spawnattr_setsigmask(&attributes, &set);
  for (const int signal : {SIGTERM, SIGHUP, SIGQUIT, SIGXFSZ, SIGPIPE}) sigaddset(&set, signal);
  if (!start.ignore_interrupt) sigaddset(&set, SIGINT);
  posix_spawnattr_setsigdefault(&attributes, &set);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
}

}  // namespace

Program::Program(const std::vector<std::string>& arguments, const Start& start)
    : out_(anonymous_file()) {
  if (start.terminal) {
    err_ = require(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC), "posix_openpt");
    require(grantpt(err_), "grantpt");
    require(unlockpt(err_), "unlockpt");
    terminal_ = require(open(ptsname(err_), O_RDWR | O_NOCTTY | O_CLOEXEC), "open terminal");
  } else {
    err_ = anonymous_file();
  }
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  if (!start.input.empty())
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, start.input.c_str(), O_RDONLY, 0);
  if (start.output == "-")
    posix_spawn_file_actions_addclose(&files, STDOUT_FILENO);
  else if (!start.output.empty())
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, start.output.c_str(), O_WRONLY, 0);
  else
    posix_spawn_file_actions_adddup2(&files, out_, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, start.terminal ? terminal_ : err_, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  set_signals(attributes, start);

  std::vector<std::string> command = {MOCLEAN_PROGRAM};
  command.insert(command.end(), arguments.begin(), arguments.end());
  std::vector<std::string> variables = environment(start);
  struct sigaction before {};
  if (start.ignore_interrupt) {
    struct sigaction ignore {};
    ignore.sa_handler = SIG_IGN;
    sigaction(SIGINT, &ignore, &before);
  }
  const int failure = posix_spawn(&process_, MOCLEAN_PROGRAM, &files, &attributes,
                                  pointers(command).data(), pointers(variables).data());
  if (start.ignore_interrupt) sigaction(SIGINT, &before, nullptr);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  require(-failure, "posix_spawn " MOCLEAN_PROGRAM);
}

Program::~Program() {
  if (process_ > 0) {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  for (const int file : {out_, err_, terminal_})
    if (file >= 0) close(file);
}

void Program::read_terminal() {
  char chunk[4096];
  for (ssize_t count; (count = ::read(err_, chunk, sizeof chunk)) > 0;)
    shown_.append(chunk, static_cast<std::size_t>(count));
}

bool Program::shows(const std::string& text) {
  siginfo_t state{};
  while (shown_.find(text) == std::string::npos) {
    read_terminal();
    if (waitid(P_PID, static_cast<id_t>(process_), &state, WEXITED | WNOHANG | WNOWAIT) != 0 ||
        state.si_pid != 0)
      return shown_.find(text) != std::string::npos;
    usleep(1000);
  }
  return true;
}

void Program::send(int signal) const {
  if (process_ > 0) kill(process_, signal);  // 0 would be our own group
}

Outcome Program::wait() {
  int status = 0;
  waitpid(process_, &status, 0);
  process_ = 0;
  Outcome outcome;
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  outcome.out = rewound_content(out_);
  if (terminal_ >= 0) read_terminal();
  outcome.err = terminal_ >= 0 ? shown_ : rewound_content(err_);
  return outcome;
}

Outcome Program::wait_at_most(std::chrono::milliseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  siginfo_t state{};
  while (waitid(P_PID, static_cast<id_t>(process_), &state, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         state.si_pid == 0 && std::chrono::steady_clock::now() < end)
    usleep(500);
  if (state.si_pid == 0) send(SIGKILL);
  return wait();
}

Outcome run(const std::vector<std::string>& arguments, const Start& start) {
  return Program(arguments, start).wait();
}

}  // namespace moclean::test
