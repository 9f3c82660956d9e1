#pragma once

#include <cstddef>

namespace moclean::fuzz {

/// Bytes that a parser may hold at a time: so many of every input, and so many per byte of it.
struct MemoryBound {
  std::size_t fixed = 1 << 20;
  std::size_t per_byte = 256;
};

/// Whether MemoryUse sees anything: only AddressSanitizer's allocator can be asked.
bool sees_memory();

/// Watches what this process allocates while it lives; one at a time.
class MemoryUse {
 public:
  MemoryUse();
  ~MemoryUse();
  MemoryUse(const MemoryUse&) = delete;
  MemoryUse& operator=(const MemoryUse&) = delete;

  /// Throws Violation if more than the bound for an input of so many bytes was held at any moment.
  void expect_within(const MemoryBound& bound, std::size_t input) const;
};

}  // namespace moclean::fuzz
