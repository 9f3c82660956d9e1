#include "moclean/run/take_reader.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
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

Index segments_of(const Segmentation& segmentation, const Clip& clip) {
  return static_cast<Index>(plan(segmentation, clip.frames()).size()) - 1;
}

}  // namespace

std::uint64_t TakeGroup::bytes() const {
  return std::transform_reduce(memory.begin(), memory.end(), std::uint64_t{0}, std::plus{},
                               [](const MemoryShare& share) { return share.bytes(); });
}

TakeReader::TakeReader(const std::vector<fs::path>& files, const InputOptions& options,
                       const GroupRules& rules, int threads, MemoryBudget& budget,
                       std::stop_token stop)
    : files_(files),
      options_(options),
      rules_(rules),
      budget_(budget),
      file_bytes_(sizes_of(files)),
      all_bytes_(std::reduce(file_bytes_.begin(), file_bytes_.end())),
      promises_(files.size()),
      stopped_(std::move(stop), [this] { stop_.request_stop(); }) {
  for (auto& promise : promises_) takes_.push_back(promise.get_future());
  const auto count = std::min(static_cast<std::size_t>(threads), files.size());
  for (std::size_t t = 0; t < count; ++t) threads_.emplace_back([this] { read_ahead(); });
}

TakeReader::~TakeReader() { stop_.request_stop(); }

// Text takes about as many bytes as the samples that become of it; read() corrects the estimate.
std::uint64_t TakeReader::expected_bytes(std::size_t index) const {
  return rules_.copies * file_bytes_[index];
}

void TakeReader::read_ahead() {
  for (;;) {
    std::unique_lock admission(admission_);
    const std::size_t index = next_++;
    if (index >= files_.size()) return;
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
  take.clip = read_solvable(files_[index], options_, rules_.needs);
  const auto samples = static_cast<std::uint64_t>(take.clip.samples.size()) * sizeof(double);
  require_room(index, rules_.copies * samples);
  memory.resize(rules_.copies * samples);
  take.memory = std::move(memory);
  take.seconds = work.seconds();
  return take;
}

void TakeReader::require_room(std::size_t index, std::uint64_t bytes) const {
  if (bytes > budget_.limit())
    throw FileError(
        files_[index],
        fmt::format("needs {} of memory, but --memory-limit leaves {} for recordings; raise it, or "
                    "use part of the recording (--frames)",
                    byte_text(bytes), byte_text(budget_.limit())));
}

// Never waits for a take that cannot be read before the group is solved: what the group and the
// next take need together is far below the budget, and all else in it is given back by the writer.
bool TakeReader::takes_another(const TakeGroup& group, std::uintmax_t file_bytes) const {
  if (at_end()) return false;
  if (group.clips.empty()) return true;
  if (group.bytes() + expected_bytes(given_) > budget_.limit() / 3) return false;
  const bool is_quarter = 4 * file_bytes >= all_bytes_;
  return group.segments < (is_quarter ? rules_.least_segments : rules_.full_segments);
}

TakeGroup TakeReader::next() {
  TakeGroup group;
  group.first = given_;
  std::uintmax_t file_bytes = 0;
  while (takes_another(group, file_bytes)) {
    Take take = takes_[given_].get();
    group.segments += segments_of(rules_.segmentation, take.clip);
    group.clips.push_back(std::move(take.clip));
    group.read_seconds.push_back(take.seconds);
    group.memory.push_back(std::move(take.memory));
    file_bytes += file_bytes_[given_++];
  }
  given_bytes_ += file_bytes;
  given_segments_ += group.segments;
  return group;
}

Index TakeReader::expected_segments() const {
  if (at_end() || given_bytes_ == 0) return given_segments_;
  const double share = static_cast<double>(given_bytes_) / static_cast<double>(all_bytes_);
  return static_cast<Index>(static_cast<double>(given_segments_) / share);
}

}  // namespace moclean
