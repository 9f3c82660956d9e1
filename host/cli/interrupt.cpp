#include "cli/interrupt.hpp"

#include <chrono>
#include <ctime>

namespace moclean::cli {
namespace {

sigset_t signals_not_ignored() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction action {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler != SIG_IGN) sigaddset(&signals, signal);
  }
  return signals;
}

}  // namespace

Interrupt::Interrupt() : signals_(signals_not_ignored()) {
  pthread_sigmask(SIG_BLOCK, &signals_, &mask_before_);
  watcher_ = std::jthread([this](std::stop_token done) { watch(done); });
}

Interrupt::~Interrupt() {
  watcher_.request_stop();
  watcher_.join();
  pthread_sigmask(SIG_SETMASK, &mask_before_, nullptr);
}

void Interrupt::watch(std::stop_token done) {
  constexpr timespec pause{.tv_sec = 0, .tv_nsec = 50'000'000};
  while (!done.stop_requested()) {
    if (sigtimedwait(&signals_, nullptr, &pause) <= 0) continue;
    source_.request_stop();
    pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);  // a second signal ends the program
    while (!done.stop_requested()) nanosleep(&pause, nullptr);
  }
}

}  // namespace moclean::cli
