#include <CLI/CLI.hpp>

#include "cli/options/config_file.hpp"
#include "cli/options/layers.hpp"
#include "fuzz/memory_use.hpp"
#include "fuzz/target.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

// As `moclean denoise take.bvh --config FILE` does, for a take in each of the folders.
void config(std::string_view input) {
  const std::filesystem::path file = as_file(input);
  const MemoryUse memory;
  succeeds([&] {
    const cli::Configuration configuration = cli::read_configuration(file);
    CLI::App command;
    cli::DenoiseOptions options;
    cli::add_denoise_options(command, options);
    command.parse("--output=clean.csv take.bvh");
    cli::DenoiseLayers layers(command);
    layers.add(configuration);
    static_cast<void>(layers.options());
    for (const cli::Configuration::Folder& folder : configuration.folders)
      static_cast<void>(layers.options(layers.folders_of(folder.path / "take.bvh")));
  });
  memory.expect_within({.fixed = 16 << 20, .per_byte = 4096}, input.size());
}

}  // namespace moclean::fuzz
