#pragma once

#include <filesystem>
#include <functional>

namespace moclean {

// What a process has made and not finished: files under temporary names, folders that are still
// empty. Destructors remove it; a process that a signal ends without them calls
// remove_unfinished(). Any number of threads may use these.

/// Whether remove_unfinished() removes a folder only if nothing is in it.
enum class UnfinishedFolder { if_empty, with_content };

/// Calls `make`, which makes something of that name, and remembers the name if it returns true.
bool make_unfinished(const std::filesystem::path& path, const std::function<bool()>& make,
                     UnfinishedFolder folder = UnfinishedFolder::if_empty);

/// Calls `settle`, which removes what has that name or gives it its place, and forgets the name.
void settle_unfinished(const std::filesystem::path& path, const std::function<void()>& settle);

/// Whether this process has made something of that name, in whatever folder, and not finished it.
bool is_unfinished(const std::filesystem::path& name);

/// Removes all of it. For a process about to end: whoever makes or
/// settles something afterwards waits for ever, so that nothing comes after.
void remove_unfinished() noexcept;

/// While one lives, this thread may wait for somebody outside to read or to write: a pipe, a
/// terminal.
class OutsideWait {
 public:
  OutsideWait();
  ~OutsideWait();
  OutsideWait(const OutsideWait&) = delete;
  OutsideWait& operator=(const OutsideWait&) = delete;
};

/// Whether a thread of this process may wait so: it will not notice that it is to stop.
bool waits_outside();

}  // namespace moclean
