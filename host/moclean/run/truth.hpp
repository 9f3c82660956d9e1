#pragma once

#include <filesystem>
#include <vector>

#include "moclean/run/inputs.hpp"

namespace moclean {

/// The truth of every file. `truth` is a file for a single one, else a folder that holds for each a
/// recording of the same name, in any format that can be read; if it holds several, the first in
/// the order of formats(). It is looked for where the file is below the folder that was given, then
/// in the folder itself. Throws FileError for one that does not exist, ArgumentError for one file
/// and several inputs.
std::vector<std::filesystem::path> truths_of(const std::filesystem::path& truth,
                                             const std::vector<std::filesystem::path>& files,
                                             const std::vector<std::filesystem::path>& inputs = {});

/// Reads a truth. Throws FileError if it is not of the shape of `noisy`.
Recording read_truth(const std::filesystem::path& file, const ReadOptions& options,
                     const Recording& noisy);

}  // namespace moclean
