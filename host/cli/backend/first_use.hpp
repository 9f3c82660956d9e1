#pragma once

#include <filesystem>

#include "cli/backend/open_backend.hpp"
#include "cli/options/denoise_options.hpp"

namespace moclean::cli {

/// Whether this version has run such methods on a device before, as far as a file in the user's
/// cache folder tells. The first time drivers compile the kernels, for seconds.
class FirstUse {
 public:
  /// Of the backend that the options have opened.
  FirstUse(const OpenedBackend& opened, const DenoiseOptions& options);

  bool is_first() const;

  /// Remembers that they have run; a cache that cannot be written remembers nothing.
  void keep() const;

 private:
  std::filesystem::path mark_;  // empty where nothing is compiled or there is no cache
};

}  // namespace moclean::cli
