#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "moclean/denoise/agreement.hpp"
#include "moclean/denoise/change.hpp"
#include "moclean/denoise/denoiser.hpp"

namespace moclean {

/// What Job::verify found for one take.
struct Verification {
  Agreement agreement;
  AgreementBounds bounds;         ///< what it was to keep
  double largest_difference = 0;  ///< of any entry of the motion, in the unit of the clip
};

/// How far a take was from the truth, and is: FD, Peng et al., equation (8).
struct TruthReport {
  std::filesystem::path file;
  double fd_noisy = 0;
  double fd_clean = 0;
};

/// One take of a run.
struct TakeReport {
  std::filesystem::path file;
  std::string failure = {};  ///< why nothing was written for it; empty if all was
  ReadingNotes notes = {};   ///< what reading it found out
  std::string unit;          ///< of length, as the file states it; empty where it does not
  Index frames = 0;
  Index columns = 0;
  double read_seconds = 0;
  double solve_seconds = 0;
  double write_seconds = 0;
  std::array<Index, 4> status{};          ///< samples of each SampleStatus
  Change changed;                         ///< of what is written
  bool tells_trust = false;               ///< the method says which samples it rejected
  std::vector<DenoisedSegment> segments;  ///< first_frame counts from the first frame used
  std::vector<std::string> unobserved;    ///< columns without a sample, left missing
  std::optional<Verification> verification;
  std::optional<TruthReport> truth;

  /// Frames per second of solving; 0 if it took no measurable time.
  double frames_per_second() const;
};

/// Wall time during which a stage was at work, on any thread. Stages overlap, so that the total may
/// be less than their sum.
struct StageSeconds {
  double read = 0;
  double solve = 0;
  double write = 0;
  double total = 0;
};

/// A whole run.
struct RunReport {
  std::vector<TakeReport> takes;  ///< in the order of the files
  StageSeconds seconds;
  Index batches = 0;              ///< of takes that were solved together
  std::uint64_t peak_memory = 0;  ///< bytes, of the whole process
};

/// What Job::verify found, in one line that starts with the file's name.
std::string agreement_line(const TakeReport& take);

/// Whether a take was changed so much that its user should hear of it: more than 2 % of its samples
/// corrected by a method that tells which it rejected (others change nearly all), or a joint moved
/// by more than 5 % of the body's size.
bool is_changed_much(const TakeReport& take);

/// How much a take was changed, likewise.
std::string changed_line(const TakeReport& take);

/// What reading a file found out that its user should hear of: lines that start with its name.
std::vector<std::string> note_lines(const std::filesystem::path& file, const ReadingNotes& notes);

/// Which columns were never observed, likewise; the take has some.
std::string unobserved_line(const TakeReport& take);

}  // namespace moclean
