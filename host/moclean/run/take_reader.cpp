#include "moclean/run/take_reader.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/formats.hpp"
#include "moclean/motion/rotation_spikes.hpp"
#include "moclean/run/byte_size.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;

std::vector<std::uintmax_t> sizes_of(const std::vector<fs::path>& files) {
  std::vector<std::uintmax_t> sizes;
  for (const fs::path& file : files) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(file, error);
    sizes.push_back(error ? 0 : size);  // a pipe has no size; reading reports what is wrong
  }
  return sizes;
}

Index segments_of(const Segmentation& segmentation, const Recording& clip) {
  return static_cast<Index>(plan(segmentation, clip.frames()).size()) - 1;
}

void require_size(const Recording& recording, const fs::path& file, const Chain& chain) {
  const auto squares = [](const Step& step) { return std::holds_alternative<LowRank>(step); };
  const auto step = std::ranges::find_if(chain, squares);
  if (step == chain.end()) return;
  if (const std::string why = too_small(recording.samples, name_of(*step)); !why.empty())
    throw FileError(file, why);
}

}  // namespace

TakeReader::TakeReader(const Job& job, const BatchRules& rules, MemoryBudget& budget, RunLog& log,
                       std::stop_token stop)
    : job_(job),
      rules_(rules),
      budget_(budget),
      log_(log),
      file_bytes_(sizes_of(job.files)),
      all_bytes_(std::reduce(file_bytes_.begin(), file_bytes_.end())),
      promises_(job.files.size()),
      stopped_(std::move(stop), [this] { stop_.request_stop(); }) {
  for (auto& promise : promises_) takes_.push_back(promise.get_future());
  const auto count = std::min(static_cast<std::size_t>(job.jobs), job.files.size());
  for (std::size_t t = 0; t < count; ++t) threads_.emplace_back([this] { read_ahead(); });
}

TakeReader::~TakeReader() { stop_.request_stop(); }

// Text takes about as many bytes as the samples that become of it; read() corrects the estimate.
std::uint64_t TakeReader::expected_bytes(std::size_t index) const {
  return rules_.copies_solving * file_bytes_[index];
}

void TakeReader::read_ahead() {
  for (;;) {
    std::unique_lock admission(admission_);
    const std::size_t index = next_++;
    if (index >= job_.files.size()) return;
    try {
      MemoryShare memory = budget_.take(expected_bytes(index), stop_.get_token());
      admission.unlock();
      promises_[index].set_value(read(index, std::move(memory)));
    } catch (...) {
      promises_[index].set_exception(std::current_exception());
    }
  }
}

TakeReader::Take TakeReader::read(std::size_t index, MemoryShare memory) {
  const BusyClock::Work work(clock_);
  require_room(index, file_bytes_[index]);
  Take take;
  take.clip = naming(job_.files[index], "read it",
                     [&] { return read_recording(job_.files[index], job_.reading); });
  if (job_.from_rotations && !clean_rotations(take.clip))
    throw FileError(job_.files[index],
                    "--from-rotations: has no rotations of a skeleton, expected " +
                        any_extension(has_skeleton));
  require_solvable(take.clip, job_.files[index], job_.reading.frames, rules_.needs);
  require_size(take.clip, job_.files[index], job_.chain);
  const std::uint64_t bytes = bytes_of(take.clip, rules_.copies_solving);
  require_room(index, bytes);
  memory.resize(bytes);
  take.memory = std::move(memory);
  take.seconds = work.seconds();
  log_.send(TakeRead{index});
  return take;
}

void TakeReader::require_room(std::size_t index, std::uint64_t bytes) const {
  if (bytes > budget_.limit())
    throw FileError(
        job_.files[index],
        fmt::format("needs {} of memory, but --memory-limit leaves {} for recordings; raise it, or "
                    "use part of the recording (--frames)",
                    byte_text(bytes), byte_text(budget_.limit())));
}

// Never waits for a take that cannot be read before the batch is solved: what the batch and the
// next take need together is far below the budget, and all else in it is given back by the writer.
bool TakeReader::takes_another(const TakeBatch& batch, std::uintmax_t file_bytes) const {
  if (at_end()) return false;
  if (batch.size() == 0) return true;
  if (batch.bytes() + expected_bytes(given_) > budget_.limit() / 3) return false;
  const bool is_quarter = 4 * file_bytes >= all_bytes_;
  return batch.segments() <
         (is_quarter ? rules_.backend.least_segments : rules_.backend.full_segments);
}

TakeBatch TakeReader::next() {
  TakeBatch batch;
  std::uintmax_t file_bytes = 0;
  while (takes_another(batch, file_bytes)) {
    const std::size_t index = given_;
    log_.attempt(index, [&] {
      Take take = takes_[index].get();
      batch.takes.push_back({.index = index,
                             .segments = segments_of(rules_.segmentation, take.clip),
                             .read_seconds = take.seconds,
                             .memory = std::move(take.memory)});
      batch.clips.push_back(std::move(take.clip));
    });
    file_bytes += file_bytes_[given_++];
  }
  given_bytes_ += file_bytes;
  given_segments_ += batch.segments();
  return batch;
}

Index TakeReader::expected_segments() const {
  if (at_end() || given_bytes_ == 0) return given_segments_;
  const double share = static_cast<double>(given_bytes_) / static_cast<double>(all_bytes_);
  return static_cast<Index>(static_cast<double>(given_segments_) / share);
}

}  // namespace moclean
