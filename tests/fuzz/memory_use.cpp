#include "fuzz/memory_use.hpp"

#include <algorithm>
#include <atomic>

#include <fmt/format.h>

#include "fuzz/target.hpp"

#ifndef __has_feature
#define __has_feature(feature) 0
#endif
#if __has_feature(address_sanitizer)
#include <sanitizer/allocator_interface.h>
#endif

namespace moclean::fuzz {
namespace {

// A few writers work on threads of their own.
std::atomic<bool> watching = false;
std::atomic<std::ptrdiff_t> held = 0, peak = 0;

#if __has_feature(address_sanitizer)
void note_allocation(const volatile void*, std::size_t bytes) {
  if (!watching.load(std::memory_order_relaxed)) return;
  const auto size = static_cast<std::ptrdiff_t>(bytes);
  const auto now = held.fetch_add(size, std::memory_order_relaxed) + size;
  if (now > peak.load(std::memory_order_relaxed)) peak.store(now, std::memory_order_relaxed);
}

void note_release(const volatile void* memory) {
  if (!watching.load(std::memory_order_relaxed) || !memory) return;
  const auto size = __sanitizer_get_allocated_size(const_cast<const void*>(memory));
  held.fetch_sub(static_cast<std::ptrdiff_t>(size), std::memory_order_relaxed);
}

[[maybe_unused]] const int hooks =
    __sanitizer_install_malloc_and_free_hooks(note_allocation, note_release);
#endif

}  // namespace

bool sees_memory() { return __has_feature(address_sanitizer); }

MemoryUse::MemoryUse() {
  held = peak = 0;
  watching = true;
}

MemoryUse::~MemoryUse() { watching = false; }

void MemoryUse::expect_within(const MemoryBound& bound, std::size_t input) const {
  const std::size_t most = bound.fixed + bound.per_byte * input;
  const auto found = static_cast<std::size_t>(peak.load());
  if (found > most)
    throw Violation(fmt::format(
        "{} bytes were held at a time for an input of {}, at most {} may be", found, input, most));
}

}  // namespace moclean::fuzz
