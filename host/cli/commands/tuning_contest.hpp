#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "moclean/backend/backend.hpp"
#include "moclean/linalg/tuning.hpp"

namespace moclean::cli {

/// One choice that was tried.
struct TriedTuning {
  enum class Result {
    same_bits,  ///< A and E are those of the default, bit for bit
    close,      ///< within the bounds of --verify of the default
    wrong       ///< differs by more than its kind of choice may: never kept
  };

  std::string choice;  ///< `tile 4 x 3`
  Tuning tuning;
  double seconds = 0;  ///< median; of the first solve where it was left out after that
  double ratio = 1;    ///< to the choice it competes with, median over the turns
  int repetitions = 0;
  Result result = Result::same_bits;
};

std::string to_string(TriedTuning::Result result);

/// How `moclean tune` measures.
struct ContestRules {
  int repetitions = 7;
  double least_gain = 0.03;  ///< share of the median time that a better choice has to save
  double hopeless = 1.5;     ///< ratio of the first solves beyond which one is left out
  bool quick = false;        ///< few choices, and none that compiles much or differs in rounding
};

/// All that was tried, and what is best.
struct ContestReport {
  std::vector<TriedTuning> tried;  ///< the first is the default
  Tuning best;
};

/// Improves on the default tuning of the device, one kind of choice after the other: eigensolver,
/// products, register tiles, rows of a sweep, panel, queues, batch. The choices of a kind take
/// turns, so that all suffer alike from what else the machine does; the result of each is compared
/// with that of the default before its time counts. Throws DeviceError, Cancelled.
ContestReport find_best_tuning(const Device& device, const SegmentBatch& data,
                               const ContestRules& rules,
                               const std::function<void(const TriedTuning&)>& report,
                               const std::stop_token& stop);

}  // namespace moclean::cli
