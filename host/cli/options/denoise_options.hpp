#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "moclean/denoise/chain.hpp"
#include "moclean/run/inputs.hpp"

#include "cli/options/backend_options.hpp"

namespace CLI {
class App;
}

namespace moclean::cli {

/// The group of the options of methods in a command's help.
inline constexpr const char* method_group = "Method";

/// The command line of `moclean denoise`.
struct DenoiseOptions : BackendOptions {
  std::vector<std::filesystem::path> inputs;  ///< files and folders, or `-`: standard input
  std::string input_format;                   ///< of standard input: extension without its dot
  ReadOptions reading;
  std::filesystem::path output;    ///< or `-`: standard output
  std::filesystem::path outliers;  ///< empty: not asked for
  std::filesystem::path mask;      ///< status of every sample; empty: not asked for
  std::filesystem::path sigma;     ///< standard deviations; empty: not asked for
  std::string format;              ///< extension without its dot, or empty

  std::string method_name;  ///< --method, as it was given; empty: see complete()
  std::optional<Index> segment_length;
  std::optional<Index> segments;
  std::optional<Index> segment_overlap;  ///< frames; default 0
  std::string division = "equal";        ///< "equal" | "auto"
  Chain chain = {LowRank{}};        ///< follows from --method and its options; set by complete()
  Segmentation segmentation;        ///< of the chain's first matrix method; set by complete()
  std::optional<double> tolerance;  ///< default: what the precision reaches
  RobustPca method;                 ///< what slra and rpca leave open; tolerance: by complete()

  std::optional<double> max_gap;  ///< seconds; longer gaps stay missing
  bool from_rotations = false;    ///< take spikes out of rotations first
  bool keep_observed = false;     ///< pass trusted samples through
  bool overlap = true;            ///< of reading, solving and writing

  std::filesystem::path report;  ///< HTML; empty: none
  std::filesystem::path truth;   ///< file, or folder of files named like the inputs; empty: none
  std::optional<FrameRange> truth_frames;  ///< default: those of the inputs

  std::filesystem::path config;  ///< see Configuration; empty: none
  bool resume = false;           ///< leave out what the manifest says is done
  bool all_or_nothing = false;   ///< one take that fails ends the run
  bool dry_run = false;          ///< say what would be done
  bool keep_raw = false;         ///< put every input beside its result
  bool force = false;            ///< results may replace inputs

  std::filesystem::path json;   ///< "-": standard output; empty: none
  std::filesystem::path lines;  ///< likewise: a line of JSON per take
  bool verify = false;
  bool profile = false;
  bool quiet = false;

  /// Whether standard output is for people.
  bool reports() const { return !quiet && json != "-" && lines != "-" && output != "-"; }
};

/// Declares the options on the command; parsing fills `options`.
void add_denoise_options(CLI::App& command, DenoiseOptions& options);

/// Finishes what the parser cannot express. Without --method it is slra where an option of robust
/// PCA or of segments is given, else auto. Throws ArgumentError for options that are missing, do
/// not go together or are out of their range.
void complete(DenoiseOptions& options);

}  // namespace moclean::cli
