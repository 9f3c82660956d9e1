#pragma once

#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "moclean/denoise/denoiser.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/report/report.hpp"
#include "moclean/run/busy_clock.hpp"
#include "moclean/run/memory_budget.hpp"
#include "moclean/run/outputs.hpp"
#include "moclean/run/run_log.hpp"
#include "moclean/run/work_queue.hpp"

namespace moclean {

/// A take that waits to be written.
struct SolvedTake {
  std::size_t index = 0;  ///< of its file
  Recording clean;        ///< the take with its motion in place of its samples
  Matrix outliers;
  std::optional<Matrix> mask;    ///< of status_numbers(), where it is asked for
  std::optional<Matrix> sigma;   ///< where it is asked for
  std::optional<Report> report;  ///< to be written, too; clean and outliers are added to it
  MemoryShare memory;
};

/// Folders that are removed again, if nothing else is in them, unless keep() is called.
class NewFolders {
 public:
  NewFolders() = default;

  /// Creates what is missing. Throws FileError.
  explicit NewFolders(const std::vector<std::filesystem::path>& folders);
  ~NewFolders();
  NewFolders(const NewFolders&) = delete;
  NewFolders& operator=(const NewFolders&) = delete;

  void keep();

 private:
  std::vector<std::filesystem::path> created_;  // outer before inner
};

/// Writes results on threads of its own: under temporary names until commit() where the run is all
/// or nothing, and without commit() the destructor removes everything that was written; else the
/// results of a take get their names as soon as they are complete.
class ResultWriter {
 public:
  /// `job` and `log` outlive the writer. Throws FileError if a folder cannot be created.
  ResultWriter(const Job& job, RunLog& log);
  ~ResultWriter();
  ResultWriter(const ResultWriter&) = delete;
  ResultWriter& operator=(const ResultWriter&) = delete;

  /// Returns at once. Throws what writing an earlier take threw, if that ends the run.
  void put(SolvedTake take);

  /// Waits until everything is written; no put() after it. Throws likewise.
  void finish();

  /// Puts the files in their places that are not yet there; after finish(). Throws FileError.
  void commit();

  double seconds() const { return clock_.seconds(); }  ///< wall time some take was being written
  double seconds(std::size_t index) const { return take_seconds_[index]; }  ///< after finish()

 private:
  void work();
  std::vector<AtomicFile> written(SolvedTake& take);
  void commit(std::size_t take, std::vector<AtomicFile>& files);
  void keep(std::size_t take, std::vector<AtomicFile> files);
  void rethrow_failure();

  const Job& job_;
  const OutputPlan& plan_;
  RunLog& log_;
  NewFolders folders_;
  BusyClock clock_;
  std::vector<double> take_seconds_;
  WorkQueue<SolvedTake> queue_;
  std::mutex mutex_;                                        // of the next two
  std::map<std::size_t, std::vector<AtomicFile>> waiting_;  // per take, for commit()
  std::exception_ptr failure_;
  std::vector<std::jthread> threads_;  // last: they use the others
};

}  // namespace moclean
