#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "moclean/linalg/tuning.hpp"

#include "cli/printing/json_record.hpp"

namespace moclean::cli {

/// Where the tuning of a device and driver is kept:
/// `$XDG_CACHE_HOME/moclean/tuning-NAME-HASH.json`, with `~/.cache` where XDG_CACHE_HOME is not set
/// or not an absolute path. Empty where HOME is not set either.
std::filesystem::path tuning_file(const DeviceInfo& device);

/// What a cache file holds.
struct CachedTuning {
  std::optional<Tuning> tuning;  ///< empty: there is none that can be used
  std::string problem;           ///< why a file that is there cannot be used; else empty
};

/// Reads the tuning of this device. A file that is damaged, of another device, driver or format, or
/// holds a choice out of its range, is a problem to report and otherwise as good as none.
CachedTuning read_tuning(const std::filesystem::path& file, const DeviceInfo& device);

/// Writes it, complete or not at all; makes the folder. Throws FileError.
void write_tuning(const std::filesystem::path& file, const DeviceInfo& device,
                  const Tuning& tuning);

/// The choices as JSON, by their names in Tuning.
Json tuning_record(const Tuning& tuning);

}  // namespace moclean::cli
