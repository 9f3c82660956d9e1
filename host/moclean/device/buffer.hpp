#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "moclean/device/device.hpp"

namespace moclean {

namespace detail {
cl::Buffer allocate(const Device& device, std::size_t bytes);
void write(const Device& device, const cl::Buffer& target, const void* source, std::size_t offset,
           std::size_t bytes);
void read(const Device& device, const cl::Buffer& source, void* target, std::size_t offset,
          std::size_t bytes);
void fill_zero(const Device& device, const cl::Buffer& target, std::size_t bytes);
}  // namespace detail

/// `size()` elements of type T in device memory. T has the layout the kernels expect.
/// Every function throws DeviceError if the device refuses. The device has to outlive the buffer.
template <class T>
class Buffer {
 public:
  Buffer() = default;

  /// Uninitialised. An empty buffer is allowed and holds no memory worth mentioning.
  Buffer(const Device& device, std::size_t size)
      : device_(&device),
        size_(size),
        memory_(detail::allocate(device, std::max<std::size_t>(1, size) * sizeof(T))) {}

  /// A copy of `values` on the device.
  Buffer(const Device& device, std::span<const T> values) : Buffer(device, values.size()) {
    write(values);
  }

  std::size_t size() const { return size_; }
  const cl::Buffer& memory() const { return memory_; }

  /// Copies `values` to the elements from `first` on; returns when they are there.
  void write(std::span<const T> values, std::size_t first = 0) {
    detail::write(*device_, memory_, values.data(), first * sizeof(T), values.size_bytes());
  }

  /// Copies the elements from `first` on to `values`, after everything enqueued before.
  void read(std::span<T> values, std::size_t first = 0) const {
    detail::read(*device_, memory_, values.data(), first * sizeof(T), values.size_bytes());
  }

  /// Sets every byte to zero.
  void fill_zero() { detail::fill_zero(*device_, memory_, size_ * sizeof(T)); }

 private:
  const Device* device_ = nullptr;
  std::size_t size_ = 0;
  cl::Buffer memory_;
};

/// Makes room for `size` elements, uninitialised, unless there is room already.
template <class T>
void grow(Buffer<T>& buffer, const Device& device, std::size_t size) {
  if (buffer.size() < size) buffer = Buffer<T>(device, size);
}

}  // namespace moclean
