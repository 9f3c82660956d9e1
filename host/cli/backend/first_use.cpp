#include "cli/backend/first_use.hpp"

#include <cstdlib>
#include <fstream>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "moclean/core/hash.hpp"
#include "moclean/core/version.hpp"

#include "cli/backend/tuning_cache.hpp"

namespace moclean::cli {
namespace {

namespace fs = std::filesystem;

// Of all that other kernels follow from, and of where PoCL keeps them.
std::string mark_name(const DeviceInfo& device, const DenoiseOptions& options) {
  Fnv1a hash;
  hash.text(device.name).text(device.driver).text(version());
  for (const Step& step : options.chain) hash.text(name_of(step));
  hash.text(to_string(options.precision));
  hash.text(options.form ? to_string(*options.form) : "");
  hash.text(options.products ? to_string(*options.products) : "");
  const char* kernels = std::getenv("POCL_CACHE_DIR");
  hash.text(kernels ? kernels : "");
  return fmt::format("used-{:016x}", hash.value());
}

}  // namespace

FirstUse::FirstUse(const OpenedBackend& opened, const DenoiseOptions& options) {
  if (!opened.device) return;
  const fs::path tuning = tuning_file(opened.device->info());
  if (!tuning.empty()) mark_ = tuning.parent_path() / mark_name(opened.device->info(), options);
}

bool FirstUse::is_first() const {
  std::error_code error;
  return !mark_.empty() && !fs::exists(mark_, error);
}

void FirstUse::keep() const {
  if (!is_first()) return;
  std::error_code ignored;
  fs::create_directories(mark_.parent_path(), ignored);
  std::ofstream{mark_};
}

}  // namespace moclean::cli
