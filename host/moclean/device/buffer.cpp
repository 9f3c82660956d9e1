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

// Plain writes, not enqueueFillBuffer, but where that is a transfer: Oclgrind 21.10 takes filled
// memory for uninitialised.
void fill_zero(const Device& device, const cl::Buffer& target, std::size_t bytes) {
  if (device.info().kind == DeviceKind::gpu && bytes > 0) {
    translate_opencl_errors("to clear memory of " + device.info().name, [&] {
      device.queue().enqueueFillBuffer(target, cl_uchar{0}, 0, bytes);
    });
    return;
  }
  constexpr std::size_t chunk = std::size_t{1} << 20;
  const std::vector<char> zeros(std::min(bytes, chunk));
  for (std::size_t offset = 0; offset < bytes; offset += chunk)
    write(device, target, zeros.data(), offset, std::min(chunk, bytes - offset));
}

}  // namespace moclean::detail
