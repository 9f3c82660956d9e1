#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "moclean/formats/line_log.hpp"
#include "moclean/run/job.hpp"

#include "cli/printing/json_record.hpp"

namespace moclean::cli {

/// The name of a manifest in a folder of results.
inline constexpr const char* manifest_name = "moclean.manifest.jsonl";

/// A take as the manifest knows it: what its results follow from, but for the content of files.
struct ManifestTake {
  std::filesystem::path file;                  ///< as it was found
  std::filesystem::path input;                 ///< what is read: the file, or what was kept of it
  std::vector<std::filesystem::path> outputs;  ///< all that is written for it, the motion first
  Json parameters;                             ///< all that decides the results
};

/// What is done in a folder of results: a line of JSON per take with hashes of its input and of all
/// its results, and what else they follow from. A line is written when the results are complete and
/// before they get their names, so that a run that is killed at any moment leaves either results
/// that match their line or some that do not; those are made again.
class Manifest {
 public:
  /// Reads the lines there are in `root`; lines that are none of a manifest are left out.
  explicit Manifest(std::filesystem::path root);

  /// Whether the last line about this take is what would be written now: same input, parameters and
  /// version, all results as they were. Where a result has replaced the input, that is the result.
  bool is_done(const ManifestTake& take) const;

  /// Whether a file is still as the last line about it has it.
  bool is_result(const std::filesystem::path& file) const;

  /// Adds a take; its results are under temporary names. Any number of threads may call it. Throws
  /// FileError.
  void add(const ManifestTake& take, const std::vector<CompleteFile>& files);

  /// The last line about every result, sorted by its name, in place of the lines as they came, also
  /// from other runs. No other run may be at work in the folder.
  void tidy();

  bool empty() const { return lines_.empty(); }

  /// The results of earlier runs, but for those that have replaced their input: `sides` alone what
  /// is no motion.
  std::vector<std::filesystem::path> results_below(const std::filesystem::path& inputs) const;
  std::vector<std::filesystem::path> sides() const;

 private:
  void read();
  std::string name_of(const std::filesystem::path& file) const;
  const Json* line_of(const std::string& output) const;

  std::filesystem::path root_;
  std::filesystem::path file_;
  std::map<std::string, Json> lines_;  // per result
  std::mutex mutex_;                   // of lines_ and log_ in add()
  std::unique_ptr<LineLog> log_;       // from the first line on
};

/// While it lives, other runs into a folder know of this one.
class FolderLock {
 public:
  /// Waits for a run that tidies up. A folder that cannot be locked is none that others use.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Calls `work` if no other run uses the folder, while none can.
  void if_alone(const std::function<void()>& work) const;

 private:
  int folder_ = -1;
};

/// Removes what killed runs have left of these files.
void remove_left_of(const std::vector<std::filesystem::path>& files);

}  // namespace moclean::cli
