#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "moclean/device/buffer.hpp"

namespace moclean {

/// Names and values that reach the kernels as -D options.
using Defines = std::map<std::string, std::string>;

/// A compiled kernel file (with kernels/prelude.cl before it).
class Program {
 public:
  /// Compiles `source` for the device, once for all its queues. Throws DeviceError with device,
  /// options and the compiler's log, whose file and line numbers are those of the .cl files.
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

/// Local memory for `size` elements of type T, as an argument of a kernel.
template <class T>
struct LocalMemory {
  std::size_t size = 0;
};

/// A kernel and the queue it runs on: `kernel(Grid{.x = n}, buffer, 3, 0.5)`. It holds the
/// arguments of a launch, so every thread needs one of its own.
class Kernel {
 public:
  Kernel(const Program& program, const std::string& name);

  /// Enqueues without waiting. Arguments are Buffer<T>, LocalMemory<T>, arithmetic types exactly as
  /// the kernel declares them, or OpenCL vectors. An empty grid is no launch. Throws DeviceError.
  template <class... Arguments>
  void operator()(const Grid& grid, const Arguments&... arguments) {
    translate_opencl_errors("in kernel " + name_, [&] {
      cl_uint index = 0;
      (set(index++, arguments), ...);
    });
    launch(grid);
  }

  /// States the work of the next launch: `kernel.with([&] { return Work{...}; })(grid, ...)`. The
  /// function is called only where the device is profiled.
  template <class WorkOf>
  Kernel& with(const WorkOf& work_of) {
    if (device_->profile()) work_ = work_of();
    return *this;
  }

  /// Work-items of the largest work-group this kernel can run with, as its registers allow.
  std::size_t largest_group() const;

 private:
  template <class T>
  void set(cl_uint index, const Buffer<T>& buffer) {
    kernel_.setArg(index, buffer.memory());
  }
  template <class T>
  void set(cl_uint index, const LocalMemory<T>& memory) {
    kernel_.setArg(index, cl::Local(memory.size * sizeof(T)));
  }
  template <class T>
  void set(cl_uint index, const T& value) {
    kernel_.setArg(index, value);
  }
  void launch(const Grid& grid);

  const Device* device_;
  std::string name_;
  cl::Kernel kernel_;
  std::optional<Work> work_;  // of the next launch, where it is known
};

}  // namespace moclean
