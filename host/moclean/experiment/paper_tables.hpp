#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "moclean/experiment/experiment.hpp"

namespace moclean {

// The experiments of Peng, Liu, Cui, Zheng, "Segmented Low Rank Approximation Approach for Motion
// Capture Data Denoising": FD of four methods (Table 2) and against the length of segments (Table
// 3), under the noise of their equation (7).

/// Which table.
enum class PaperTable { methods = 2, segment_lengths = 3 };

/// A sequence of the paper and what it prints for it.
struct PaperSequence {
  /// FD of SLRA in segments of so many frames.
  struct Length {
    Index frames;
    double fd;
  };

  std::string_view name;  ///< "Seq3"
  std::string_view take;  ///< CMU subject and trial: "14_06"
  Index frames;           ///< the first so many
  Index noisy_frames;     ///< p of equation (7)
  Index segment_length;   ///< of Table 2
  double slra;            ///< Table 2
  double tsvd;
  double svt;
  double rpca;
  std::array<Length, 4> lengths;  ///< Table 3
};

/// The three sequences.
std::span<const PaperSequence> paper_sequences();

/// The sequence of a take of this name (14_06); null if it is none of the paper's.
const PaperSequence* find_sequence(std::string_view take_name);

/// One row: a method, and what the paper prints for it.
struct PaperRow {
  std::size_t method = 0;              ///< index into Experiment::methods
  std::string label;                   ///< of the row
  std::optional<double> printed = {};  ///< the paper's FD; nothing for takes it does not have
};

/// A take's part of a table.
struct PaperPart {
  const PaperSequence* sequence = nullptr;  ///< null: not the paper's
  Index noisy_frames = 0;
  std::vector<PaperRow> rows;
};

/// A table as an experiment: one noise per take.
struct PaperExperiment {
  Experiment experiment;
  std::vector<PaperPart> parts;  ///< per take
  std::vector<Cell> cells;       ///< seeded by the experiment's seeds, as `moclean corrupt --seed`
};

/// The experiment behind a table. The rows of a take of the paper are the paper's if the take is
/// cut as the paper's (`is_papers`, per take); else a third of the frames are noisy, and segments
/// are those of 200, 400, 700 and 1400 frames that cut the take at all (Table 3), or of 200 (Table
/// 2). The first row is the noisy take itself. `defaults` is what slra and rpca leave open. svt
/// takes its threshold from the median singular value (see SingularValueThresholding): the paper
/// does not say how it chose one.
PaperExperiment paper_experiment(PaperTable table, std::vector<ExperimentTake> takes,
                                 const std::vector<bool>& is_papers,
                                 std::vector<std::uint64_t> seeds, const RobustPca& defaults = {});

}  // namespace moclean
