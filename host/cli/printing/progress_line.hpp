#pragma once

#include <chrono>
#include <string>

#include "moclean/backend/backend.hpp"

namespace moclean::cli {

/// Whether the number of segments to come is known, or estimated from the size of files not read.
enum class ProgressTotal { exact, estimated };

/// One line on standard error that says how far a computation is; nothing if standard error is not
/// a terminal. The destructor clears it.
class ProgressLine {
 public:
  /// `task` starts the line, e.g. "solving"; `unit` is what is counted; `waiting` is said until the
  /// first is finished.
  ProgressLine(std::string task, bool wanted, std::string unit = "segments",
               std::string waiting = "");
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Rewrites the line, at most ten times a second.
  void show(const Progress& progress, ProgressTotal total = ProgressTotal::exact);

 private:
  using Clock = std::chrono::steady_clock;

  std::string task_;
  std::string unit_;
  bool visible_;
  std::string waiting_;
  Clock::time_point begin_ = Clock::now();  // from the first finished one on: when that was
  Index begun_at_ = 0;                      // how many were finished then
  Clock::time_point shown_ = {};
};

/// The text of the line, for instance `solving: 12 of 140 segments, 35.0 segments/s, 4 s left`.
/// `seconds` are those in which all but the first `before` have finished; rate and time left are
/// absent until a few have. An estimated total is `about 140`.
std::string progress_text(const std::string& task, const Progress& progress, double seconds,
                          ProgressTotal total = ProgressTotal::exact,
                          const std::string& unit = "segments", Index before = 0);

}  // namespace moclean::cli
