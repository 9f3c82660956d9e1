#pragma once

// The one place that includes OpenCL, in the version every device of today understands.
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wignored-attributes"
#include <CL/opencl.hpp>
#pragma GCC diagnostic pop

#include <string>
#include <utility>

#include "moclean/core/error.hpp"

namespace moclean {

/// The name of an OpenCL status code, `CL_OUT_OF_RESOURCES`; the number where it is not known.
std::string opencl_status(cl_int status);

/// The OpenCL function that a cl::Error names: the bindings say `Retain Object`, and misspell one.
std::string opencl_function(const char* name);

/// Runs `work` and turns a cl::Error into a DeviceError that says what was attempted. The only
/// translation of OpenCL failures; `what` reads "to allocate 8192 bytes on pthread-skylake".
template <class Work>
auto translate_opencl_errors(const std::string& what, Work&& work) {
  try {
    return std::forward<Work>(work)();
  } catch (const cl::Error& error) {
    throw DeviceError("OpenCL failed " + what + ": " + opencl_function(error.what()) +
                      " returned " + opencl_status(error.err()));
  }
}

}  // namespace moclean
