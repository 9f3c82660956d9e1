#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/types.h>

#include "support/temporary_folder.hpp"

namespace moclean::test {

/// How a run of `moclean` ended.
struct Outcome {
  int exit_code = 0;  ///< negative: the signal that killed it
  std::string out;
  std::string err;

  nlohmann::json json() const { return nlohmann::json::parse(out); }
};

/// How `moclean` is started.
struct Start {
  std::string device = {};  ///< MOCLEAN_DEVICE; unset where empty
  std::string cache = {};   ///< XDG_CACHE_HOME; a folder without tunings where empty
  std::string input = {};   ///< file that is standard input; that of the tests where empty
  std::string output = {};  ///< file that is standard output; `-`: closed
  std::vector<std::string> environment = {};  ///< further variables, NAME=VALUE
  bool terminal = false;                      ///< standard error is a terminal
  bool ignore_interrupt = false;              ///< SIGINT is ignored, as under nohup
};

/// A running `moclean`.
class Program {
 public:
  explicit Program(const std::vector<std::string>& arguments, const Start& start = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Waits until standard error, a terminal, has shown the text; false if the program ended first.
  bool shows(const std::string& text);

  void send(int signal) const;

  /// Waits for the end.
  Outcome wait();

  /// Waits for the end; kills what still runs after `time`, so that its exit code is -SIGKILL.
  Outcome wait_at_most(std::chrono::milliseconds time);

 private:
  void read_terminal();

  pid_t process_ = 0;
  int out_ = -1;
  int err_ = -1;       // file, or master side of the terminal
  int terminal_ = -1;  // the other side, kept open so that nothing unread is lost
  std::string shown_;
};

/// Runs `moclean` to its end.
Outcome run(const std::vector<std::string>& arguments, const Start& start = {});

}  // namespace moclean::test
