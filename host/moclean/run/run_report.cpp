#include "moclean/run/run_report.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace moclean {
namespace {

// Two digits, but no fewer than the whole number has.
std::string percent(double share) {
  return share < 0.095 ? fmt::format("{:.2g} %", 100 * share)
                       : fmt::format("{:.0f} %", 100 * share);
}

std::string apart(int difference) {
  return difference == 0 ? "equal" : fmt::format("differ by up to {}", difference);
}

}  // namespace

double TakeReport::frames_per_second() const {
  return solve_seconds > 0 ? static_cast<double>(frames) / solve_seconds : 0;
}

bool is_changed_much(const TakeReport& take) {
  constexpr double many = 0.02, far = 0.05;
  return (take.tells_trust && take.changed.corrected > many) || take.changed.largest_share() > far;
}

std::string changed_line(const TakeReport& take) {
  const Change& changed = take.changed;
  std::string line =
      fmt::format("{}: changed much: {} of the samples corrected, {} filled", take.file.string(),
                  percent(changed.corrected), percent(changed.filled));
  if (changed.largest.distance == 0) return line;
  line += fmt::format("; farthest: {} by {:.3g}{} in frame {}", changed.largest.joint,
                      changed.largest.distance, take.unit.empty() ? "" : " " + take.unit,
                      changed.largest.frame);
  if (changed.body_size > 0)
    line += fmt::format(" ({} of the body's size)", percent(changed.largest_share()));
  return line;
}

std::vector<std::string> note_lines(const std::filesystem::path& file, const ReadingNotes& notes) {
  constexpr std::size_t named = 6;
  std::vector<std::string> lines;
  for (const std::string& warning : notes.warnings)
    lines.push_back(fmt::format("{}: {}", file.string(), warning));
  const std::vector<std::string>& columns = notes.passed_through;
  if (columns.empty()) return lines;
  const auto shown = columns.begin() + static_cast<Index>(std::min(named, columns.size()));
  lines.push_back(fmt::format("{}: {} column{} pass{} through: {}{}", file.string(), columns.size(),
                              columns.size() == 1 ? "" : "s", columns.size() == 1 ? "es" : "",
                              fmt::join(columns.begin(), shown, ", "),
                              columns.size() > named ? ", ..." : ""));
  return lines;
}

std::string unobserved_line(const TakeReport& take) {
  return fmt::format("{}: never observed, left missing: {}", take.file.string(),
                     fmt::join(take.unobserved, ", "));
}

std::string agreement_line(const TakeReport& take) {
  const auto& [agreement, bounds, largest] = *take.verification;
  return fmt::format(
      "{}: difference to the reference: motion {:.1e} (bound {:.0e}), outliers {:.1e} (bound "
      "{:.0e}), largest {:.1e}; iterations {}, ranks {}",
      take.file.string(), agreement.low_rank, bounds.low_rank, agreement.sparse, bounds.sparse,
      largest, apart(agreement.iterations_apart), apart(agreement.ranks_apart));
}

}  // namespace moclean
