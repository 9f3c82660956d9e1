#pragma once

#include <filesystem>

namespace moclean {

/// The .asf that belongs to an .amc, looked for in the .amc's folder: the same stem; else the
/// longest part of the stem that ends before a `_` (14_06.amc: 14.asf; HDM_bd_x.amc: HDM_bd.asf);
/// else the only .asf there is. Throws FileError that says what was looked for.
std::filesystem::path find_skeleton(const std::filesystem::path& amc);

}  // namespace moclean
