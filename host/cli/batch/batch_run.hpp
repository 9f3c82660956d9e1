#pragma once

#include <functional>
#include <stop_token>
#include <string>

#include "moclean/backend/backend.hpp"
#include "moclean/run/events.hpp"
#include "moclean/run/run_report.hpp"

#include "cli/batch/batch_plan.hpp"

namespace moclean::cli {

/// Is told what happens; takes are counted over the whole plan.
using BatchSink = std::function<void(const RunEvent&)>;

/// Runs the takes of a plan that are not done, one job per setting, and keeps the manifest in the
/// folder of results, if there is one. Reports are in the order of the files; those of takes that
/// were done have only the file. Throws as run_job().
RunReport run_batch(const BatchPlan& plan, Manifest* manifest, Backend& backend,
                    const BatchSink& sink, const std::stop_token& stop);

/// `input -> output: method`, or why a take is left out: a line per take.
std::string dry_run_text(const BatchPlan& plan);

}  // namespace moclean::cli
