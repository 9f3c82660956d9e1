#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "moclean/linalg/tuning.hpp"

#include "cli/printing/profile_report.hpp"

namespace moclean::cli {

/// What a run of `moclean denoise` computed with.
struct BackendReport {
  std::string name;
  std::optional<Tuning> tuning = {};       ///< empty for the reference
  std::filesystem::path tuning_file = {};  ///< where it is from; empty: the defaults of the device
  std::optional<ProfileReport> profile = {};
};

}  // namespace moclean::cli
