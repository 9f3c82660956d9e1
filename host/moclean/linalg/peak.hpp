#pragma once

#include "moclean/device/device.hpp"

namespace moclean {

/// What a device was seen to do at most; per second.
struct Peak {
  double double_flops = 0;  ///< multiply-adds on registers, counted as two
  double float_flops = 0;
  double bytes = 0;  ///< read and written while copying far more than its caches hold
};

/// Runs two short kernels of kernels/linalg/peak.cl, about a fifth of a second on a CPU.
/// Throws DeviceError if the device has no double precision.
Peak measure_peak(const Device& device);

}  // namespace moclean
