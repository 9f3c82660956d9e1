#pragma once

#include <csignal>
#include <stop_token>
#include <thread>

namespace moclean::cli {

/// Turns Ctrl-C (SIGINT) and SIGTERM into a stop request while it lives.
///
/// The first signal requests the stop; the second ends the program at once, as without this class.
/// A signal that was ignored when the program started (nohup, jobs in the background) stays
/// ignored. Has to be made before any other thread: threads inherit that the signals are blocked,
/// so that only the watching thread receives them.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const { return source_.get_token(); }

 private:
  void watch(std::stop_token done);

  sigset_t signals_;
  sigset_t mask_before_;
  std::stop_source source_;
  std::jthread watcher_;  // last: it uses the others
};

}  // namespace moclean::cli
