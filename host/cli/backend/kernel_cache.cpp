#include "cli/backend/kernel_cache.hpp"

#include <cstdlib>
#include <system_error>

#include <unistd.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/temporary_name.hpp"

#include "cli/printing/say.hpp"

namespace moclean::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* variable = "POCL_CACHE_DIR";

bool can_be_used(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  return !error && fs::is_directory(folder, error) && access(folder.c_str(), W_OK | X_OK) == 0;
}

}  // namespace

fs::path kernel_cache(const std::function<const char*(const char*)>& environment) {
  const auto value = [&](const char* name) {
    const char* text = environment(name);
    return fs::path(text ? text : "");
  };
  if (const fs::path own = value(variable); !own.empty()) return own;
  if (const fs::path cache = value("XDG_CACHE_HOME"); !cache.empty()) return cache / "pocl/kcache";
  if (const fs::path home = value("HOME"); !home.empty()) return home / ".cache/pocl/kcache";
  return "/tmp/pocl/kcache";
}

void require_kernel_cache() {
  const fs::path folder = kernel_cache([](const char* name) { return std::getenv(name); });
  if (can_be_used(folder)) return;
  try {
    setenv(variable, make_temporary_folder().c_str(), 1);
  } catch (const FileError& error) {
    throw DeviceError("the OpenCL driver needs a folder for its kernels: " + folder.string() +
                      " cannot be used, nor " + error.what());
  }
  warn("no kernels can be kept in {}: they are compiled anew in every run; {} names another folder",
       folder.string(), variable);
}

}  // namespace moclean::cli
