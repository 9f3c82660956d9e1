#pragma once

#include <memory>
#include <string>

#include "moclean/solve/opencl/opencl_backend.hpp"
#include "moclean/solve/reference/reference_backend.hpp"

#include "support/device.hpp"

namespace moclean::test {

/// Every backend the contract of Backend is tested on.
enum class BackendKind { reference, reference_two_jobs, opencl_own, opencl_clblast };

inline std::string to_string(BackendKind kind) {
  switch (kind) {
    case BackendKind::reference:
      return "Reference";
    case BackendKind::reference_two_jobs:
      return "ReferenceTwoJobs";
    case BackendKind::opencl_own:
      return "OpenClOwn";
    case BackendKind::opencl_clblast:
      break;
  }
  return "OpenClClblast";
}

inline std::unique_ptr<Backend> make_backend(BackendKind kind) {
  switch (kind) {
    case BackendKind::reference:
      return std::make_unique<ReferenceBackend>(1);
    case BackendKind::reference_two_jobs:
      return std::make_unique<ReferenceBackend>(2);
    case BackendKind::opencl_own:
      return std::make_unique<OpenClBackend>(device());
    case BackendKind::opencl_clblast:
      break;
  }
  return std::make_unique<OpenClBackend>(device(), OpenClOptions{.products = ProductPath::clblast});
}

}  // namespace moclean::test
