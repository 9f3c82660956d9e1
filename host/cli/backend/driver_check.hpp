#pragma once

#include <filesystem>
#include <functional>

namespace moclean::cli {

/// Asks the OpenCL driver for its devices in a child process where it may end the process that
/// asks: PoCL does without /sys, as in some containers. Call it before any thread is made. Throws
/// DeviceError that says what is missing and how to mend it.
void require_driver();

/// Likewise: `ask` stands for the driver, which needs the folder `cpus` to be readable.
void require_driver(const std::filesystem::path& cpus, const std::function<void()>& ask);

}  // namespace moclean::cli
