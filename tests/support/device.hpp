#pragma once

#include <cstdlib>

#include "moclean/device/device.hpp"

namespace moclean::test {

/// The device all tests of a process share: $MOCLEAN_DEVICE, else the best one. Opening it fails,
/// and does not skip, where there is none: the suite is worth nothing without a device. It is never
/// closed: OpenCL drivers (Oclgrind) may be gone by the time static objects are destroyed.
inline const Device& device() {
  static const char* selection = std::getenv("MOCLEAN_DEVICE");
  static const Device* shared = new Device(selection ? selection : "");
  return *shared;
}

}  // namespace moclean::test
