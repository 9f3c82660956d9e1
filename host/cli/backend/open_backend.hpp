#pragma once

#include <memory>

#include "moclean/backend/backend.hpp"
#include "moclean/device/device.hpp"

#include "cli/options/backend_options.hpp"
#include "cli/printing/backend_report.hpp"

namespace moclean::cli {

/// A backend, what it stands on, and what there is to say about it.
struct OpenedBackend {
  std::unique_ptr<Device> device;  ///< has to outlive the backend; null for the reference
  std::unique_ptr<Backend> backend;
  BackendReport report;
};

/// Opens what the options ask for, with the tuning that is kept for the device. Where `needed` is
/// false (filters only) no device is opened. A tuning that cannot be used is a warning on standard
/// error. Throws DeviceError.
OpenedBackend open_backend(const BackendOptions& options, bool needed,
                           Profiling profiling = Profiling::off);

}  // namespace moclean::cli
