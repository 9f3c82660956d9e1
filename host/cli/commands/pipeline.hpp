#pragma once

#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "moclean/run/outputs.hpp"
#include "moclean/run/take_report.hpp"
#include "moclean/solve/backend.hpp"

#include "cli/options/denoise_options.hpp"

namespace moclean::cli {

/// What a run of `moclean denoise` works on.
struct Job {
  const DenoiseOptions& options;
  std::vector<std::filesystem::path> files;
  OutputPlan plan = {};
  std::vector<std::filesystem::path> truths = {};  ///< one per file; empty: none
  std::string backend = {};                        ///< its name, for reports
  int compute_units = 1;  ///< of the backend: how many segments it wants at once depends on it
  bool on_gpu = false;    ///< and on this
};

/// Reads, solves and writes all takes, group after group: while one is solved, the next ones are
/// read and the ones before it written, in bounded memory (see TakeReader). With --no-overlap all
/// are read, then solved, then written.
///
/// The results appear under their names when all takes are done; if anything fails, or a stop is
/// requested, none does. The grouping does not change the results. Throws what the stages throw,
/// Error if --verify finds a difference, Cancelled.
RunReport run_pipeline(const Job& job, Backend& backend, const std::stop_token& stop = {});

}  // namespace moclean::cli
