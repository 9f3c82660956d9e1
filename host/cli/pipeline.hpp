#pragma once

#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "moclean/solve/backend.hpp"

#include "cli/denoise_options.hpp"
#include "cli/outputs.hpp"
#include "cli/take_report.hpp"

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

/// The share of --memory-limit that a device batch may take; the rest is for the host.
constexpr std::uint64_t device_share(std::uint64_t memory_limit) { return memory_limit / 4; }

/// Reads, solves and writes all takes, group after group: while one is solved, the next ones are
/// read and the ones before it written, in bounded memory (see TakeReader). With --no-overlap all
/// are read, then solved, then written.
///
/// The results appear under their names when all takes are done; if anything fails, or a stop is
/// requested, none does. The grouping does not change the results. Throws what the stages throw,
/// Error if --verify finds a difference, Cancelled.
RunReport run_pipeline(const Job& job, Backend& backend, const std::stop_token& stop = {});

}  // namespace moclean::cli
