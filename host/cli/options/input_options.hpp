#pragma once

#include <filesystem>
#include <string>

#include "moclean/formats/formats.hpp"
#include "moclean/run/inputs.hpp"

namespace CLI {
class App;
}

namespace moclean::cli {

/// A help text and the extensions of the formats of which `trait` is true: `Recording (.bvh .csv)`.
std::string with_extensions(const std::string& text, FormatTrait trait);

/// Reads `A:B`, `A:`, `:B` or `:`. Throws ArgumentError, naming the option, for anything else, and
/// if A >= B.
FrameRange parse_frame_range(const std::string& text, const std::string& option = "--frames");

/// --frames, with the help text of a command.
void add_frames_option(CLI::App& command, FrameRange& frames, const std::string& help);

/// --rate and --skeleton: what files do not say themselves.
void add_file_options(CLI::App& command, double& rate, std::filesystem::path& skeleton);

/// --layout, --columns and --missing: how the columns of tables and arrays become samples.
void add_column_options(CLI::App& command, ReadOptions& options);

/// --frames, and all those.
void add_input_options(CLI::App& command, ReadOptions& options);

}  // namespace moclean::cli
