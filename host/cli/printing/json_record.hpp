#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "moclean/run/run_report.hpp"

#include "cli/options/denoise_options.hpp"

namespace moclean::cli {

/// Keeps the members in the order they were added in.
using Json = nlohmann::ordered_json;

struct BackendReport;

/// The record of a whole run.
Json json_record(const DenoiseOptions& options, const BackendReport& backend, const RunReport& run);

/// The record of one take of a run: what became of it, or why it failed.
Json take_record(const TakeReport& take);

/// JSON as text with a newline at its end. Numbers that are not finite become null, and bytes that
/// are not UTF-8 (file names) the replacement character.
std::string to_text(const Json& json);

/// Writes that text to a file, or to standard output if the file is `-`. Throws FileError.
void write_json(const std::filesystem::path& file, const Json& json);

}  // namespace moclean::cli
