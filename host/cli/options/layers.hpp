#pragma once

#include <filesystem>
#include <vector>

#include "cli/options/config_file.hpp"
#include "cli/options/denoise_options.hpp"

namespace moclean::cli {

/// The options of `moclean denoise` in layers: those of a configuration for all takes, over them
/// those for the folders of a take, outer before inner, and over all the command line. An option
/// also takes the place of those below that it excludes.
class DenoiseLayers {
 public:
  /// The options of a parsed command line without configuration.
  explicit DenoiseLayers(const CLI::App& command);

  /// Puts a configuration below them. Throws FileError naming file and line of an option that does
  /// not exist, cannot be set there or has a value out of its range.
  void add(const Configuration& configuration);

  /// Which tables of the configuration are about a take, outer before inner; `below` is its path
  /// below the folder that was given.
  std::vector<std::size_t> folders_of(const std::filesystem::path& below) const;

  /// Warnings of tables that are about none of these takes.
  std::vector<std::string> unused(const std::vector<std::filesystem::path>& takes_below) const;

  /// The options of takes in these folders, complete(). Throws ArgumentError for options that do
  /// not go together.
  DenoiseOptions options(const std::vector<std::size_t>& folders = {}) const;

 private:
  Configuration configuration_;
  std::vector<Setting> given_;  // on the command line
};

}  // namespace moclean::cli
