#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "moclean/run/run_report.hpp"

namespace moclean::cli {

/// What a person is told of a take that was written: lines with their ends.
std::string take_text(const TakeReport& take, const std::filesystem::path& result);

/// How many takes a run has done, has failed to do and has left out, how much it has changed, the
/// largest change and where, and the seconds: the last lines of a run. `done_before` has a value
/// per take that is not 0 if it was left out.
std::string run_text(const RunReport& run, const std::vector<char>& done_before);

}  // namespace moclean::cli
