#include "moclean/run/result_writer.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "moclean/core/error.hpp"
#include "moclean/formats/read_write.hpp"
#include "moclean/formats/unfinished.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;

// A folder and those around it that do not exist, outer before inner.
std::vector<fs::path> missing_folders(const fs::path& folder) {
  std::vector<fs::path> missing;
  fs::path path = fs::absolute(folder).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();  // a slash at its end
  for (; !fs::exists(path); path = path.parent_path()) missing.insert(missing.begin(), path);
  return missing;
}

AtomicFile copied(const FileCopy& copy) {
  AtomicFile file(copy.to);
  file.write(read_file(copy.from));
  file.close();
  return file;
}

}  // namespace

// Delegates, so that the destructor removes what was created before a failure.
NewFolders::NewFolders(const std::vector<fs::path>& folders) : NewFolders() {
  for (const fs::path& folder : folders)
    for (const fs::path& missing : missing_folders(folder)) {
      std::error_code error;
      const bool made =
          make_unfinished(missing, [&] { return fs::create_directory(missing, error); });
      if (error) throw FileError(missing, "cannot be created: " + error.message());
      if (made) created_.push_back(missing);
    }
}

NewFolders::~NewFolders() {
  for (auto folder = created_.rbegin(); folder != created_.rend(); ++folder)
    settle_unfinished(*folder, [&] {
      std::error_code ignored;  // another program may have put a file there
      fs::remove(*folder, ignored);
    });
}

void NewFolders::keep() {
  for (const fs::path& folder : created_) settle_unfinished(folder, [] {});
  created_.clear();
}

ResultWriter::ResultWriter(const Job& job, RunLog& log)
    : job_(job),
      plan_(job.outputs),
      log_(log),
      folders_(plan_.folders),
      take_seconds_(plan_.clean.size()) {
  const auto count = std::min(static_cast<std::size_t>(job.jobs), plan_.clean.size());
  for (std::size_t t = 0; t < count; ++t) threads_.emplace_back([this] { work(); });
}

ResultWriter::~ResultWriter() {
  queue_.clear();
  queue_.close();
}

void ResultWriter::put(SolvedTake take) {
  rethrow_failure();
  queue_.push(std::move(take));
}

void ResultWriter::finish() {
  queue_.close();
  threads_.clear();
  rethrow_failure();
}

void ResultWriter::commit() {
  for (auto& [take, files] : waiting_) commit(take, files);
  if (log_.all_or_nothing()) folders_.keep();  // else those that are not empty stay
}

// The copies are the first: an input is kept before its result replaces it.
void ResultWriter::commit(std::size_t take, std::vector<AtomicFile>& files) {
  if (job_.before_commit) {
    std::vector<CompleteFile> complete;
    for (const AtomicFile& file : files) complete.push_back({file.target(), file.temporary()});
    job_.before_commit(take, complete);
  }
  for (AtomicFile& file : files) file.commit();
  log_.send(TakeWritten{take});
}

// After a failure the takes that wait are dropped all the same: others wait for their memory.
void ResultWriter::work() {
  while (auto take = queue_.pop()) {
    try {
      {
        const std::lock_guard lock(mutex_);
        if (failure_) continue;
      }
      log_.attempt(take->index, [&] {
        keep(take->index,
             naming(plan_.clean[take->index], "write it", [&] { return written(*take); }));
      });
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
    }
  }
}

// Complete, under temporary names.
std::vector<AtomicFile> ResultWriter::written(SolvedTake& take) {
  const BusyClock::Work work(clock_);
  std::vector<AtomicFile> files;
  if (!plan_.copies.empty())
    for (const FileCopy& copy : plan_.copies[take.index]) files.push_back(copied(copy));
  Recording outliers = like(take.clean, std::move(take.outliers));
  files.push_back(write_temporary(plan_.clean[take.index], take.clean));
  if (!plan_.outliers.empty())
    files.push_back(write_temporary(plan_.outliers[take.index], outliers));
  if (take.mask)
    files.push_back(
        write_temporary(plan_.masks[take.index], like(take.clean, *std::move(take.mask))));
  if (take.sigma)
    files.push_back(
        write_temporary(plan_.sigmas[take.index], like(take.clean, *std::move(take.sigma))));
  if (take.report) {
    take.report->take->clean = std::move(take.clean);
    take.report->take->outliers = std::move(outliers);
    AtomicFile& file = files.emplace_back(plan_.reports[take.index]);
    file.write(html(*take.report));
    file.close();
  }
  take_seconds_[take.index] = work.seconds();
  return files;
}

void ResultWriter::keep(std::size_t take, std::vector<AtomicFile> files) {
  if (!log_.all_or_nothing()) {
    commit(take, files);
    return;
  }
  const std::lock_guard lock(mutex_);
  waiting_.emplace(take, std::move(files));
}

void ResultWriter::rethrow_failure() {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace moclean
