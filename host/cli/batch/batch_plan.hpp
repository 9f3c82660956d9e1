#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "moclean/run/inputs.hpp"
#include "moclean/run/outputs.hpp"

#include "cli/batch/manifest.hpp"
#include "cli/options/layers.hpp"

namespace moclean::cli {

/// What `moclean denoise` is going to do, take by take.
struct BatchPlan {
  std::vector<DenoiseOptions> settings;       ///< the first are those of no folder
  std::vector<std::filesystem::path> files;   ///< one per take, as found
  std::vector<std::size_t> setting_of;        ///< likewise, place in `settings`
  std::vector<std::filesystem::path> truths;  ///< likewise, or empty
  std::vector<ManifestTake> records;          ///< likewise
  std::vector<char> done = {};                ///< likewise: not 0 if it need not be done again
  OutputPlan outputs;
  PassedBy passed_by;  ///< in folders; what is unreadable is a failure
  std::vector<std::string> warnings;

  const DenoiseOptions& common() const { return settings.front(); }
  const DenoiseOptions& options_of(std::size_t take) const { return settings[setting_of[take]]; }

  /// Whether a take that fails leaves the others alone.
  bool goes_on_after_failures() const;

  /// Each setting that is used with its takes that are not done, in the order of their files.
  std::vector<std::vector<std::size_t>> groups() const;
};

/// Finds the takes, their settings and their places; `common` are those of no folder. Throws
/// ArgumentError and FileError, before anything is computed or written.
BatchPlan plan_batch(const DenoiseLayers& layers, const DenoiseOptions& common);

/// Reads what is done from the manifest.
void leave_out_done(const Manifest& manifest, BatchPlan& plan);

/// All files of a take, the motion first.
std::vector<std::filesystem::path> results_of(const OutputPlan& outputs, std::size_t take);

}  // namespace moclean::cli
