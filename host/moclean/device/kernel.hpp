#pragma once

#include <map>
#include <string>
#include <string_view>

#include "moclean/device/buffer.hpp"

namespace moclean {

/// Names and values that reach the kernels as -D options.
using Defines = std::map<std::string, std::string>;

/// A compiled kernel file (with kernels/prelude.cl before it).
class Program {
 public:
  /// Compiles `source` for the device. Throws DeviceError with device, options and the compiler's
  /// log, whose file and line numbers are those of the .cl files.
  Program(const Device& device, std::string_view source, const Defines& defines);

  const Device& device() const { return *device_; }
  const cl::Program& handle() const { return program_; }

 private:
  const Device* device_;
  cl::Program program_;
};

/// Work-items of a launch: global is rounded up to whole work-groups, so kernels test their range.
struct Grid {
  std::size_t x = 1;
  std::size_t y = 1;
  std::size_t z = 1;
  std::size_t group_x = 1;  ///< work-items of a work-group along x; along y and z it is 1
};

/// A kernel and the queue it runs on: `kernel(Grid{.x = n}, buffer, 3, 0.5)`.
class Kernel {
 public:
  Kernel(const Program& program, const std::string& name);

  /// Enqueues without waiting. Arguments are Buffer<T>, arithmetic types exactly as the kernel
  /// declares them, or OpenCL vectors. An empty grid is no launch. Throws DeviceError.
  template <class... Arguments>
  void operator()(const Grid& grid, const Arguments&... arguments) {
    translate_opencl_errors("in kernel " + name_, [&] {
      cl_uint index = 0;
      (set(index++, arguments), ...);
    });
    launch(grid);
  }

 private:
  template <class T>
  void set(cl_uint index, const Buffer<T>& buffer) {
    kernel_.setArg(index, buffer.memory());
  }
  template <class T>
  void set(cl_uint index, const T& value) {
    kernel_.setArg(index, value);
  }
  void launch(const Grid& grid) const;

  const Device* device_;
  std::string name_;
  cl::Kernel kernel_;
};

}  // namespace moclean
