#pragma once

#include <csignal>
#include <stop_token>
#include <thread>

namespace moclean::cli {

/// Ends the program on SIGINT (Ctrl-C), SIGTERM, SIGHUP, SIGQUIT and SIGXCPU, while it lives:
/// removes what is unfinished (unfinished.hpp) and exits with ExitCode::interrupted. At once, but
/// for an Interrupt.
///
/// A signal that was ignored when the program started (nohup, jobs in the background) stays
/// ignored. A pipe whose reader has gone and a limit for the size of files become errors of who
/// writes. Has to be made before any other thread: threads inherit that the signals are blocked, so
/// that only the watching thread receives them.
class SignalWatch {
 public:
  SignalWatch();
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

 private:
  sigset_t signals_;
  std::jthread watcher_;  // last: it uses the others
};

/// While it lives, the first such signal is a stop request. The second ends the program, and so
/// does the first where a thread waits for somebody outside (OutsideWait), as it cannot stop.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
};

}  // namespace moclean::cli
