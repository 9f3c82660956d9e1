#include "cli/interrupt.hpp"

#include <ctime>
#include <mutex>
#include <optional>
#include <string_view>

#include <unistd.h>

#include "moclean/formats/unfinished.hpp"

#include "cli/commands/commands.hpp"

namespace moclean::cli {
namespace {

// Signals are of the process, and so is what they are to stop.
std::mutex work_mutex;
std::optional<std::stop_source> work;

sigset_t signals_not_ignored() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU}) {
    struct sigaction action {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler != SIG_IGN) sigaddset(&signals, signal);
  }
  return signals;
}

// Other threads go on meanwhile, so destructors of static objects must not run.
[[noreturn]] void end_program() {
  remove_unfinished();
  constexpr std::string_view message = "moclean: interrupted\n";
  [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, message.data(), message.size());
  _exit(static_cast<int>(ExitCode::interrupted));
}

void watch(const sigset_t& signals, const std::stop_token& done) {
  constexpr timespec pause{.tv_sec = 0, .tv_nsec = 50'000'000};
  while (!done.stop_requested()) {
    const bool signalled = sigtimedwait(&signals, nullptr, &pause) > 0;
    const std::lock_guard lock(work_mutex);
    const bool asked_before = work && work->stop_requested();
    if (signalled && (!work || asked_before)) end_program();
    if (signalled) work->request_stop();
    if ((signalled || asked_before) && waits_outside()) end_program();
  }
}

}  // namespace

SignalWatch::SignalWatch() : signals_(signals_not_ignored()) {
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  for (const int signal : {SIGPIPE, SIGXFSZ}) sigaction(signal, &ignore, nullptr);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  // LLVM, with which PoCL compiles, puts a handler of its own where one was ignored.
  sigset_t of_files;
  sigemptyset(&of_files);
  sigaddset(&of_files, SIGXFSZ);
  pthread_sigmask(SIG_BLOCK, &of_files, nullptr);
  watcher_ = std::jthread([this](const std::stop_token& done) { watch(signals_, done); });
}

// The signals stay blocked: what comes after is the end of the program.
SignalWatch::~SignalWatch() = default;

Interrupt::Interrupt() {
  const std::lock_guard lock(work_mutex);
  work = source_;
}

Interrupt::~Interrupt() {
  const std::lock_guard lock(work_mutex);
  work.reset();
}

}  // namespace moclean::cli
