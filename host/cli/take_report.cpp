#include "cli/take_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace moclean::cli {
namespace {

std::string apart(int difference) {
  return difference == 0 ? "equal" : fmt::format("differ by up to {}", difference);
}

}  // namespace

double TakeReport::frames_per_second() const {
  return solve_seconds > 0 ? static_cast<double>(frames) / solve_seconds : 0;
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

}  // namespace moclean::cli
