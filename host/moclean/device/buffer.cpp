#include "moclean/device/buffer.hpp"

#include <vector>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean::detail {

// Drivers of GPUs allocate at the first use, and then it is a launch that fails; NVIDIA's accepts
// any size.
cl::Buffer allocate(const Device& device, std::size_t bytes) {
  if (bytes > device.info().global_memory)
    throw DeviceError(fmt::format("{} bytes do not fit the {} of {}", bytes,
                                  device.info().global_memory, device.info().name));
  return translate_opencl_errors(
      fmt::format("to allocate {} bytes on {}", bytes, device.info().name),
      [&] { return cl::Buffer(device.context(), CL_MEM_READ_WRITE, bytes); });
}

void write(const Device& device, const cl::Buffer& target, const void* source, std::size_t offset,
           std::size_t bytes) {
  if (bytes == 0) return;
  translate_opencl_errors("to copy to " + device.info().name, [&] {
    device.queue().enqueueWriteBuffer(target, CL_TRUE, offset, bytes, source);
  });
}

void read(const Device& device, const cl::Buffer& source, void* target, std::size_t offset,
          std::size_t bytes) {
  if (bytes == 0) return;
  translate_opencl_errors("to copy from " + device.info().name, [&] {
    device.queue().enqueueReadBuffer(source, CL_TRUE, offset, bytes, target);
  });
}

// Written once and then copied on the device: a transfer costs a GPU more than all else. Not
// enqueueFillBuffer: Oclgrind 21.10 takes filled memory for uninitialised.
void fill_zero(const Device& device, const cl::Buffer& target, std::size_t bytes) {
  const std::vector<char> zeros(std::min(bytes, std::size_t{1} << 20));
  write(device, target, zeros.data(), 0, zeros.size());
  translate_opencl_errors("to clear memory of " + device.info().name, [&] {
    for (std::size_t cleared = zeros.size(); cleared < bytes;) {
      const std::size_t count = std::min(cleared, bytes - cleared);
      device.queue().enqueueCopyBuffer(target, target, 0, cleared, count);
      cleared += count;
    }
  });
}

}  // namespace moclean::detail
