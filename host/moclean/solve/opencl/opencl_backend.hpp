#pragma once

#include <cstdint>
#include <memory>

#include "moclean/device/device.hpp"
#include "moclean/linalg/products.hpp"
#include "moclean/solve/backend.hpp"

namespace moclean {

struct OpenClOptions {
  ProductPath products = ProductPath::own;
  /// Bytes of device memory one batch may take; larger input is solved in several batches. 0: three
  /// quarters of the device's memory.
  std::uint64_t memory_limit = 0;
};

/// Solves every segment of a batch at once on an OpenCL device, in double precision.
/// Throws DeviceError if the device has no double precision.
class OpenClBackend final : public Backend {
 public:
  /// `device` has to outlive the backend. Compiles the kernels.
  explicit OpenClBackend(const Device& device, const OpenClOptions& options = {});
  ~OpenClBackend() override;

  std::string name() const override;

  /// See Backend. Also throws DeviceError if one segment alone exceeds the memory limit.
  Solution solve(const SegmentBatch& data, const Method& method,
                 const Monitor& monitor = {}) override;

 private:
  struct Solvers;  // compiled kernels of each method

  const Device& device_;
  OpenClOptions options_;
  std::unique_ptr<Solvers> solvers_;
};

}  // namespace moclean
