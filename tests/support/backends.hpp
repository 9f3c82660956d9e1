#pragma once

#include <memory>
#include <string>

#include "moclean/backend/opencl_backend.hpp"
#include "moclean/backend/reference_backend.hpp"

#include "support/device.hpp"

namespace moclean::test {

/// Every backend the contract of Backend is tested on.
enum class BackendKind {
  reference,
  reference_two_jobs,
  opencl_cpu,
  opencl_clblast,
  opencl_gpu64,  // all of the GPU form, in work-groups of 64
  opencl_gpu128,
  opencl_gpu256
};

inline std::string to_string(BackendKind kind) {
  switch (kind) {
    case BackendKind::reference:
      return "Reference";
    case BackendKind::reference_two_jobs:
      return "ReferenceTwoJobs";
    case BackendKind::opencl_cpu:
      return "OpenClCpu";
    case BackendKind::opencl_clblast:
      return "OpenClClblast";
    case BackendKind::opencl_gpu64:
      return "OpenClGpuGroup64";
    case BackendKind::opencl_gpu128:
      return "OpenClGpuGroup128";
    case BackendKind::opencl_gpu256:
      break;
  }
  return "OpenClGpuGroup256";
}

inline std::unique_ptr<Backend> make_gpu_backend(int work_group) {
  const Tuning tuning{.form = KernelForm::gpu, .work_group = work_group, .eigen = KernelForm::gpu};
  return std::make_unique<OpenClBackend>(device(), OpenClOptions{.tuning = tuning});
}

inline std::unique_ptr<Backend> make_backend(BackendKind kind) {
  switch (kind) {
    case BackendKind::reference:
      return std::make_unique<ReferenceBackend>(1);
    case BackendKind::reference_two_jobs:
      return std::make_unique<ReferenceBackend>(2);
    case BackendKind::opencl_cpu:
      return std::make_unique<OpenClBackend>(
          device(), OpenClOptions{.form = KernelForm::cpu, .products = ProductPath::own});
    case BackendKind::opencl_clblast:
      return std::make_unique<OpenClBackend>(
          device(), OpenClOptions{.form = KernelForm::cpu, .products = ProductPath::clblast});
    case BackendKind::opencl_gpu64:
      return make_gpu_backend(64);
    case BackendKind::opencl_gpu128:
      return make_gpu_backend(128);
    case BackendKind::opencl_gpu256:
      break;
  }
  return make_gpu_backend(256);
}

}  // namespace moclean::test
