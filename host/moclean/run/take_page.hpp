#pragma once

#include <vector>

#include "moclean/report/report.hpp"
#include "moclean/run/job.hpp"
#include "moclean/run/run_report.hpp"

namespace moclean {

/// The skeleton that a page draws for a take: the input's, else that of InputOptions::skeleton,
/// else that of its truth. Empty if none of them fits the joints of `noisy`.
std::vector<int> parents_of(const Job& job, std::size_t take, const Clip& noisy);

/// The page of one take: `parts` and what the run says about it.
Report take_page(const Job& job, const Backend& backend, const TakeReport& take, ReportTake parts);

}  // namespace moclean
