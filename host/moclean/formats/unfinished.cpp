#include "moclean/formats/unfinished.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <new>
#include <system_error>
#include <vector>

namespace moclean {
namespace {

namespace fs = std::filesystem;

struct Unfinished {
  std::timed_mutex mutex;
  struct Entry {
    fs::path path;
    UnfinishedFolder folder;
  };
  std::vector<Entry> entries;  // in the order they were made, so that folders precede their files
  std::atomic<int> waiting = 0;
};

// Of the process, and never destroyed: threads may still run when static objects are. In memory of
// its own: the first who asks may be who ends the process because there is none.
Unfinished& unfinished() {
  alignas(Unfinished) static std::byte memory[sizeof(Unfinished)];
  static auto& all = *new (memory) Unfinished;
  return all;
}

}  // namespace

bool make_unfinished(const fs::path& path, const std::function<bool()>& make,
                     UnfinishedFolder folder) {
  Unfinished& all = unfinished();
  const std::lock_guard lock(all.mutex);
  all.entries.push_back({path, folder});  // first: after it nothing fails
  const bool made = make();
  if (!made) all.entries.pop_back();
  return made;
}

void settle_unfinished(const fs::path& path, const std::function<void()>& settle) {
  Unfinished& all = unfinished();
  const std::lock_guard lock(all.mutex);
  settle();
  std::erase_if(all.entries, [&](const auto& entry) { return entry.path == path; });
}

bool is_unfinished(const fs::path& name) {
  Unfinished& all = unfinished();
  const std::lock_guard lock(all.mutex);
  return std::any_of(all.entries.begin(), all.entries.end(),
                     [&](const auto& entry) { return entry.path.filename() == name; });
}

void remove_unfinished() noexcept {
  Unfinished& all = unfinished();
  // For ever. Whoever has it, and does not give it back, is stuck: better no lock than no end.
  static_cast<void>(all.mutex.try_lock_for(std::chrono::seconds(2)));
  std::error_code ignored;
  for (auto entry = all.entries.rbegin(); entry != all.entries.rend(); ++entry)
    if (entry->folder == UnfinishedFolder::with_content)
      fs::remove_all(entry->path, ignored);
    else
      fs::remove(entry->path, ignored);
}

OutsideWait::OutsideWait() { ++unfinished().waiting; }

OutsideWait::~OutsideWait() { --unfinished().waiting; }

bool waits_outside() { return unfinished().waiting > 0; }

}  // namespace moclean
