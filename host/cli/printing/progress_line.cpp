#include "cli/printing/progress_line.hpp"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace moclean::cli {
namespace {

constexpr const char* clear_line = "\r\033[K";

}  // namespace

std::string progress_text(const std::string& task, const Progress& progress, double seconds,
                          ProgressTotal total, const std::string& unit, Index before) {
  constexpr Index few = 2;
  if (progress.total == 0) return task;
  std::string text =
      fmt::format("{}: {} of {}{} {}", task, progress.finished,
                  total == ProgressTotal::estimated ? "about " : "", progress.total, unit);
  if (progress.finished - before < few || seconds <= 0) return text;
  const double rate = static_cast<double>(progress.finished - before) / seconds;
  const double left = static_cast<double>(progress.total - progress.finished) / rate;
  return text + fmt::format(", {:.1f} {}/s, {:.0f} s left", rate, unit, std::ceil(left));
}

ProgressLine::ProgressLine(std::string task, bool wanted, std::string unit, std::string waiting)
    : task_(std::move(task)),
      unit_(std::move(unit)),
      visible_(wanted && isatty(STDERR_FILENO) == 1),
      waiting_(std::move(waiting)) {
  if (!visible_) return;
  std::fputs((clear_line + task_ + (waiting_.empty() ? "" : ": " + waiting_)).c_str(), stderr);
}

ProgressLine::~ProgressLine() {
  if (visible_) std::fputs(clear_line, stderr);
}

void ProgressLine::show(const Progress& progress, ProgressTotal total) {
  const Clock::time_point now = Clock::now();
  if (begun_at_ == 0 && progress.finished > 0) {
    begin_ = now;
    begun_at_ = progress.finished;
  }
  if (!visible_ || now - shown_ < std::chrono::milliseconds(100)) return;
  shown_ = now;
  const std::chrono::duration<double> seconds = now - begin_;
  const std::string text =
      progress.finished == 0 && !waiting_.empty()
          ? task_ + ": " + waiting_
          : progress_text(task_, progress, seconds.count(), total, unit_, begun_at_);
  std::fputs((clear_line + text).c_str(), stderr);
}

}  // namespace moclean::cli
