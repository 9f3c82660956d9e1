#pragma once

#include <cstdint>
#include <utility>

#include "moclean/linalg/batch.hpp"

namespace moclean {

/// What a buffer holds before the first launch writes to it. Zero where launches leave something
/// out: padding, segments that take no part.
enum class Initially { undefined, zero };

/// The device memory of a method, stated once: a struct whose members are made by a layout has its
/// buffers if that describes a batch, and tells only their bytes if it describes one segment.
///
///   struct Memory {
///     explicit Memory(MemoryLayout& of) : D(of.stacked()), G(of.square(Initially::zero)) {}
///     Buffer<double> D, G;
///   };
///   MemoryLayout layout(device, batch);             Memory memory(layout);    // allocates
///   memory_of<Memory>(rows, columns)                                          // counts
///
/// Sizes are those of Batch; `count` matrices or vectors lie one after the other in a buffer, none
/// if it is 0.
class MemoryLayout {
 public:
  MemoryLayout(const Device& device, const Batch& batch);

  /// Of a segment of this size: buffers come out empty. Counts the segment's share of the Batch
  /// too.
  MemoryLayout(Index rows, Index columns);

  /// Bytes of all buffers so far.
  std::uint64_t bytes() const { return bytes_; }

  template <class T = double>
  Buffer<T> stacked(Initially initially = Initially::undefined,
                    Index count = 1) {  ///< rows x pitch
    return make<T>(stacked_, count, initially);
  }
  template <class T = double>
  Buffer<T> square(Initially initially = Initially::undefined,
                   Index count = 1) {  ///< order x order pitch
    return make<T>(square_, count, initially);
  }
  template <class T = double>
  Buffer<T> vector(Initially initially = Initially::undefined, Index count = 1) {  ///< order pitch
    return make<T>(vector_, count, initially);
  }
  template <class T = double>
  Buffer<T> partial_grams(
      Initially initially = Initially::undefined) {  ///< of all blocks but the first
    return make<T>(partial_, 1, initially);
  }
  template <class T = double>
  Buffer<T> per_row(Index count = 1) {
    return make<T>(rows_, count, Initially::undefined);
  }
  template <class T = double>
  Buffer<T> per_block(Initially initially = Initially::undefined, Index count = 1) {
    return make<T>(blocks_, count, initially);
  }
  /// Rows that every block works on at a time, `rows` x pitch each.
  template <class T = double>
  Buffer<T> chunks(Index rows, Initially initially = Initially::undefined) {
    return make<T>(blocks_, rows * pitch_, initially);
  }
  /// One for every vector of so many columns, of every segment.
  template <class T = double>
  Buffer<T> per_vector_of_columns(int width) {
    return make<T>(segments_, pitch_ / width, Initially::undefined);
  }
  template <class T = double>
  Buffer<T> per_segment(Initially initially = Initially::undefined, Index count = 1) {
    return make<T>(segments_, count, initially);
  }

 private:
  template <class T>
  Buffer<T> make(std::size_t size, Index count, Initially initially) {
    size *= static_cast<std::size_t>(count);
    bytes_ += size * sizeof(T);
    if (!device_) return {};
    Buffer<T> buffer(*device_, size);
    if (initially == Initially::zero) buffer.fill_zero();
    return buffer;
  }

  const Device* device_ = nullptr;  // none: only counts
  Index pitch_;
  std::size_t rows_, stacked_, square_, vector_, partial_, blocks_, segments_;
  std::uint64_t bytes_ = 0;
};

/// Bytes of device memory that a segment takes in a batch whose buffers are a `Memory`, made from a
/// MemoryLayout and `more`.
template <class Memory, class... More>
std::uint64_t memory_of(Index rows, Index columns, const More&... more) {
  MemoryLayout layout(rows, columns);
  [[maybe_unused]] const Memory memory(layout, more...);
  return layout.bytes();
}

}  // namespace moclean
