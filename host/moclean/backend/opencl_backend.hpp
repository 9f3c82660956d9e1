#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "moclean/backend/backend.hpp"
#include "moclean/device/device.hpp"
#include "moclean/linalg/precision.hpp"
#include "moclean/linalg/products.hpp"
#include "moclean/solve/opencl/batch_plan.hpp"

namespace moclean {

struct OpenClOptions {
  std::optional<KernelForm> form = {};       ///< overrides that of `tuning`
  std::optional<ProductPath> products = {};  ///< overrides those of `tuning`
  Precision precision = Precision::f64;
  /// Bytes of device memory the batches in flight may take together; larger input is solved in more
  /// batches, and in fewer at a time. 0: three quarters of the device's memory.
  std::uint64_t memory_limit = 0;
  std::optional<Tuning> tuning = {};  ///< default_tuning() of the device if empty
  int jobs = 1;  ///< threads for what the host does between launches; no result depends on them
};

/// Smallest tolerance that float matrices are sure to reach.
inline constexpr double mixed_tolerance = 1e-6;

/// Solves the segments of a batch on an OpenCL device, many at once: they are divided into batches
/// of which up to Tuning::queues run at the same time, each on a thread with a queue of its own.
/// One thread at a time may call solve; Monitor::report is called from any of these threads.
/// Methods throw DeviceError if they need double precision and the device has none.
class OpenClBackend final : public Backend {
 public:
  /// `device` has to outlive the backend. Throws ArgumentError for a tuning out of its range, and
  /// for `form` gpu or `products` of CLBlast in mixed precision, which has neither; a `tuning` that
  /// asks for them gets the form cpu and products of our own there. Compiles nothing, see
  /// prepare().
  explicit OpenClBackend(const Device& device, const OpenClOptions& options = {});
  ~OpenClBackend() override;

  std::string name() const override;
  BackendTraits traits() const override;

  /// The choices in use.
  const Tuning& tuning() const { return tuning_; }

  void prepare(const Method& method) override;

  /// See Backend. Also throws DeviceError if one segment alone exceeds the memory limit, and
  /// ArgumentError for a tolerance below mixed_tolerance in mixed precision, and for any method but
  /// robust PCA in it.
  Solution solve(const Problem& problem, const Method& method,
                 const Monitor& monitor = {}) override;

 private:
  class Worker;  // of one of the queues

  // Of a method that is prepared.
  opencl::SegmentSize size_of(const SegmentBatch& data, Index b, const Method& method) const;
  opencl::BatchPlan plan_of(const SegmentBatch& data, const Method& method) const;
  void prepare_workers(const opencl::BatchPlan& plan);
  template <class Chosen>
  void require_precision(const Chosen& method) const;

  const Device& device_;
  OpenClOptions options_;
  Tuning tuning_;
  std::vector<std::unique_ptr<Worker>> workers_;  // the first has the queue of the device
};

}  // namespace moclean
