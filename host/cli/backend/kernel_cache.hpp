#pragma once

#include <filesystem>
#include <functional>

namespace moclean::cli {

/// Where PoCL keeps the kernels that it compiles, from the environment as PoCL 3 does: the
/// variables POCL_CACHE_DIR, XDG_CACHE_HOME and HOME, else a folder for temporary files.
std::filesystem::path kernel_cache(const std::function<const char*(const char*)>& environment);

/// Gives PoCL a folder of this process where it could keep no kernels: it then has no device or
/// cannot build, and does not say why. Warns that they are compiled anew. Before the driver starts.
void require_kernel_cache();

}  // namespace moclean::cli
