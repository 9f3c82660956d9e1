#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "moclean/denoise/low_rank.hpp"
#include "moclean/linalg/products.hpp"

#include "cli/inputs.hpp"

namespace moclean::cli {

/// The command line of `moclean denoise`.
struct DenoiseOptions {
  std::vector<std::filesystem::path> inputs;  ///< files and folders
  InputOptions reading;
  std::filesystem::path output;
  std::filesystem::path outliers;  ///< empty: not asked for
  std::string format;              ///< "csv", "npy" or empty

  std::string method_name = "slra";  ///< "slra" | "rpca"
  std::optional<Index> segment_length;
  std::optional<Index> segments;
  Segmentation segmentation;  ///< follows from the three above; set by complete()
  RobustPca method;

  std::string backend = "opencl";  ///< "opencl" | "reference"
  std::string device;
  ProductPath products = ProductPath::own;
  int jobs = 1;

  std::filesystem::path json;  ///< "-": standard output; empty: none
  bool verify = false;
  bool quiet = false;

  bool reports() const { return !quiet && json != "-"; }  ///< whether standard output is for people
};

/// Declares the options on the command; parsing fills `options`.
void add_denoise_options(CLI::App& command, DenoiseOptions& options);

/// Finishes what the parser cannot express. Throws ArgumentError for options that do not go
/// together or are out of their range.
void complete(DenoiseOptions& options);

}  // namespace moclean::cli
