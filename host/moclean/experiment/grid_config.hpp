#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "moclean/experiment/experiment.hpp"

namespace moclean {

/// Frames first up to but not including last; either end may be open.
struct FrameSpan {
  std::optional<Index> first = {};
  std::optional<Index> last = {};

  bool operator==(const FrameSpan&) const = default;
};

/// One [[take]] of a grid file.
struct GridTake {
  std::filesystem::path file;  ///< relative paths are relative to the grid file
  std::string label;           ///< default: name of the file, without extension
  FrameSpan frames = {};
  Index thin = 1;         ///< every so many frames is used, and the rate divided by it
  bool optional = false;  ///< left out, visibly, if the file does not exist
  double rate = 0;        ///< Hz for files that state none; 0: none given
  std::filesystem::path skeleton = {};
  std::vector<std::string> excluded = {};  ///< columns_exclude, of the file's top and its own
  std::size_t line = 0;                    ///< where it stands
};

/// What a grid file says. Takes are not read yet.
struct GridConfig {
  std::filesystem::path file;
  std::vector<GridTake> takes;
  std::vector<ExperimentNoise> noises;
  std::vector<ExperimentMethod> methods;
  std::vector<std::uint64_t> seeds;
};

/// The value of an environment variable, or null.
using Environment = std::function<const char*(const char*)>;

/// Reads a grid file; docs/experiment.md has its keys. `${NAME}` and `${NAME:-otherwise}` in paths
/// stand for environment variables. `defaults` is what methods leave open. Throws FileError naming
/// file, line, key and what was expected.
GridConfig read_grid(const std::filesystem::path& file, const StepDefaults& defaults = {},
                     const Environment& environment = {});

/// The takes of a grid, read and cut, and the files of optional ones that are not there.
struct GridTakes {
  std::vector<ExperimentTake> takes;
  std::vector<std::filesystem::path> missing;
};

/// Reads the takes; `frames` holds for those that state none. Throws FileError for a file that
/// cannot be read, has missing samples or fewer frames than asked for, and if no take is left.
GridTakes read_takes(const GridConfig& config, const FrameSpan& frames = {});

/// Reads `A:B`, either left out; nothing for anything else, and if A >= B.
std::optional<FrameSpan> parse_frame_span(std::string_view text);

}  // namespace moclean
