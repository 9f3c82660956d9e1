#pragma once

#include <filesystem>
#include <string_view>

#include "moclean/formats/npy_array.hpp"

namespace moclean {

/// Reads the Python dictionary {'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), } of an
/// .npy file into an array without items, whatever its type. Throws FileError.
NpyArray parse_npy_header(std::string_view header, const std::filesystem::path& file);

}  // namespace moclean
