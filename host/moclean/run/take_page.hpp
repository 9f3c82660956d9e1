#pragma once

#include <vector>

#include "moclean/report/report.hpp"
#include "moclean/run/job.hpp"
#include "moclean/run/run_report.hpp"

namespace moclean {

/// The skeleton that a page draws for a take: its own, else that of its truth, if there is one.
/// Empty if neither fits the joints of `noisy`.
std::vector<int> parents_of(const Recording& noisy, const Recording* truth);

/// The page of one take: `parts` and what the run says about it.
Report take_page(const Job& job, const Backend& backend, const TakeReport& take, ReportTake parts);

}  // namespace moclean
