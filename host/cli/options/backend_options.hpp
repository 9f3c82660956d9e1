#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "moclean/linalg/precision.hpp"
#include "moclean/linalg/tuning.hpp"

namespace CLI {
class App;
}

namespace moclean::cli {

/// What command lines and tuning files of earlier versions call KernelForm::gpu with products of
/// our own.
inline constexpr std::string_view former_gpu_products = "group";

/// Where and in how much memory a command computes.
struct BackendOptions {
  std::string backend = "opencl";  ///< "opencl" | "reference"
  std::string device;
  std::optional<KernelForm> form;       ///< default: that of the tuning
  std::optional<ProductPath> products;  ///< default: those of the tuning
  bool former_spelling = false;         ///< `--products group`, until complete_backend()
  Precision precision = Precision::f64;
  bool use_tuning = true;  ///< what `moclean tune` has found
  int jobs = 1;
  bool limits_memory = false;      ///< --memory-limit was given
  std::uint64_t memory_limit = 0;  ///< bytes; set by complete_backend() where it is not given
};

/// The group of these options in a command's help.
inline constexpr const char* backend_group = "Where it is computed";

/// Declares --backend, --device, --form, --products, --precision, --no-tuning, --jobs and
/// --memory-limit.
void add_backend_options(CLI::App& command, BackendOptions& options);

/// Finishes what the parser cannot express. Throws ArgumentError for options that do not go
/// together.
void complete_backend(BackendOptions& options);

}  // namespace moclean::cli
