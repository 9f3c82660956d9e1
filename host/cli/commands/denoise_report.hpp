#pragma once

#include <vector>

#include "moclean/report/report.hpp"

#include "cli/commands/pipeline.hpp"

namespace moclean::cli {

/// The skeleton that a report draws for a take: the input's, else that of --skeleton, else that of
/// its truth. Empty if none of them fits the joints of `noisy`.
std::vector<int> parents_of(const Job& job, std::size_t take, const Clip& noisy);

/// The page of one take: `parts` and what the run says about it.
Report denoise_report(const Job& job, const TakeReport& take, ReportTake parts);

}  // namespace moclean::cli
