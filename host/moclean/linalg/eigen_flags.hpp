#pragma once

#include "moclean/linalg/batch.hpp"

namespace moclean {

/// What both forms of the eigensolver keep per segment: a count that chooses every segment and
/// wants every vector, and whether QL gave up.
class EigenFlags {
 public:
  explicit EigenFlags(const Device& device) : device_(&device) {}

  void reserve(const Batch& batch);

  const Buffer<std::int32_t>& all() const { return all_; }
  Buffer<std::int32_t>& failed() { return failed_; }

  /// Waits, and throws DeviceError naming the first segment that failed since the last call.
  void check(const Batch& batch);

 private:
  const Device* device_;
  Buffer<std::int32_t> all_, failed_;
};

}  // namespace moclean
