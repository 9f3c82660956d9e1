#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "moclean/denoise/agreement.hpp"
#include "moclean/denoise/denoiser.hpp"

#include "cli/denoise_options.hpp"

namespace moclean::cli {

/// Keeps the members in the order they were added in.
using Json = nlohmann::ordered_json;

/// What --verify found for one take.
struct Verification {
  Agreement agreement;
  double largest_difference = 0;  ///< of any entry of the motion, in the unit of the clip
};

/// One take of a run of `moclean denoise`.
struct TakeReport {
  std::filesystem::path file;
  Index frames = 0;
  Index columns = 0;
  double read_seconds = 0;
  double solve_seconds = 0;
  double write_seconds = 0;
  std::vector<DenoisedSegment> segments;  ///< first_frame counts from the first frame used
  std::optional<Verification> verification;

  /// Frames per second of solving; 0 if it took no measurable time.
  double frames_per_second() const;
};

/// The record of a whole run; `device` is the backend's name.
Json json_record(const DenoiseOptions& options, const std::string& device,
                 const std::vector<TakeReport>& takes);

/// JSON as text with a newline at its end. Numbers that are not finite become null, and bytes that
/// are not UTF-8 (file names) the replacement character.
std::string to_text(const Json& json);

}  // namespace moclean::cli
