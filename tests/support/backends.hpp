#pragma once

#include <memory>
#include <string>

#include "moclean/solve/opencl/opencl_backend.hpp"
#include "moclean/solve/reference/reference_backend.hpp"

#include "support/device.hpp"

namespace moclean::test {

/// Every backend the contract of Backend is tested on.
enum class BackendKind {
  reference,
  reference_two_jobs,
  opencl_own,
  opencl_clblast,
  opencl_group64,  // everything in work-groups, as on a GPU
  opencl_group128,
  opencl_group256
};

inline std::string to_string(BackendKind kind) {
  switch (kind) {
    case BackendKind::reference:
      return "Reference";
    case BackendKind::reference_two_jobs:
      return "ReferenceTwoJobs";
    case BackendKind::opencl_own:
      return "OpenClOwn";
    case BackendKind::opencl_clblast:
      return "OpenClClblast";
    case BackendKind::opencl_group64:
      return "OpenClGroup64";
    case BackendKind::opencl_group128:
      return "OpenClGroup128";
    case BackendKind::opencl_group256:
      break;
  }
  return "OpenClGroup256";
}

inline std::unique_ptr<Backend> make_group_backend(int work_group) {
  const Tuning tuning{
      .products = ProductPath::group, .work_group = work_group, .eigen = EigenForm::group};
  return std::make_unique<OpenClBackend>(device(), OpenClOptions{.tuning = tuning});
}

inline std::unique_ptr<Backend> make_backend(BackendKind kind) {
  switch (kind) {
    case BackendKind::reference:
      return std::make_unique<ReferenceBackend>(1);
    case BackendKind::reference_two_jobs:
      return std::make_unique<ReferenceBackend>(2);
    case BackendKind::opencl_own:
      return std::make_unique<OpenClBackend>(device(), OpenClOptions{.products = ProductPath::own});
    case BackendKind::opencl_clblast:
      return std::make_unique<OpenClBackend>(device(),
                                             OpenClOptions{.products = ProductPath::clblast});
    case BackendKind::opencl_group64:
      return make_group_backend(64);
    case BackendKind::opencl_group128:
      return make_group_backend(128);
    case BackendKind::opencl_group256:
      break;
  }
  return make_group_backend(256);
}

}  // namespace moclean::test
