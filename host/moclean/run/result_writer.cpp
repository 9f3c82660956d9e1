#include "moclean/run/result_writer.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "moclean/core/error.hpp"
#include "moclean/formats/read_write.hpp"

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

}  // namespace

// Delegates, so that the destructor removes what was created before a failure.
NewFolders::NewFolders(const std::vector<fs::path>& folders) : NewFolders() {
  for (const fs::path& folder : folders)
    for (const fs::path& missing : missing_folders(folder)) {
      std::error_code error;
      fs::create_directory(missing, error);
      if (error) throw FileError(missing, "cannot be created: " + error.message());
      created_.push_back(missing);
    }
}

NewFolders::~NewFolders() {
  std::error_code ignored;  // another program may have put a file there
  for (auto folder = created_.rbegin(); folder != created_.rend(); ++folder)
    fs::remove(*folder, ignored);
}

ResultWriter::ResultWriter(const OutputPlan& plan, int threads)
    : plan_(plan), folders_(plan.folders), take_seconds_(plan.clean.size()) {
  const auto count = std::min(static_cast<std::size_t>(threads), plan.clean.size());
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
  for (AtomicFile& file : written_) file.commit();
  folders_.keep();
}

// After a failure the takes that wait are dropped all the same: others wait for their memory.
void ResultWriter::work() {
  while (auto take = queue_.pop()) {
    try {
      {
        const std::lock_guard lock(mutex_);
        if (failure_) continue;
      }
      write(*take);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
    }
  }
}

void ResultWriter::write(SolvedTake& take) {
  const BusyClock::Work work(clock_);
  std::vector<AtomicFile> files;
  files.push_back(write_temporary(plan_.clean[take.index], take.clip));
  if (!plan_.outliers.empty())
    files.push_back(write_temporary(plan_.outliers[take.index], take.outliers));
  if (take.mask) files.push_back(write_temporary(plan_.masks[take.index], *take.mask));
  if (take.sigma) files.push_back(write_temporary(plan_.sigmas[take.index], *take.sigma));
  if (take.report) {
    take.report->take->clean = std::move(take.clip);
    take.report->take->outliers = std::move(take.outliers);
    AtomicFile& file = files.emplace_back(plan_.reports[take.index]);
    file.write(html(*take.report));
    file.close();
  }
  take_seconds_[take.index] = work.seconds();
  const std::lock_guard lock(mutex_);
  for (AtomicFile& file : files) written_.push_back(std::move(file));
}

void ResultWriter::rethrow_failure() {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace moclean
