#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace moclean::cli {

/// What a configuration says of one option.
struct Setting {
  std::string option;               ///< its long name without dashes
  std::vector<std::string> values;  ///< as on a command line; none for a flag that is false
  bool is_flag = false;             ///< true or false
  std::size_t line = 0;
};

/// A configuration of `moclean denoise`: settings for all takes, and for those of some folders.
struct Configuration {
  struct Folder {
    std::filesystem::path path;  ///< below the folder of takes that is given
    std::vector<Setting> settings;
    std::size_t line = 0;
  };
  std::filesystem::path file;
  std::vector<Setting> settings;
  std::vector<Folder> folders;
};

/// Reads TOML: keys are names of options, `[[folder]]` tables have a `path` and keys of their own.
/// Which options there are is not known here. Throws FileError naming file, line and what was
/// expected.
Configuration read_configuration(const std::filesystem::path& file);

}  // namespace moclean::cli
