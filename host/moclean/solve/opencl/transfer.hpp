#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "moclean/device/buffer.hpp"
#include "moclean/solve/opencl/stacked_rows.hpp"

namespace moclean::opencl {

// Between the host, which works in double, and stacked matrices of either number type.

inline void upload(std::span<const double> values, Buffer<double>& target) { target.write(values); }

inline void upload(std::span<const double> values, Buffer<float>& target) {
  target.write(std::vector<float>(values.begin(), values.end()));
}

inline void download(const Buffer<double>& source, std::span<double> values) {
  source.read(values);
}

inline void download(const Buffer<float>& source, std::span<double> values) {
  std::vector<float> floats(values.size());
  source.read(floats);
  std::ranges::copy(floats, values.begin());
}

/// The segments [first, last), of which those named (counted from `first`) are replaced by
/// by(segment).
template <class Real, class By>
void upload(const SegmentBatch& data, Index first, Index last,
            const std::vector<std::int32_t>& replaced, const By& by, Buffer<Real>& target) {
  SegmentBatch values = segments_between(data, first, last);
  for (const std::int32_t b : replaced) values.segment(b) = by(data.segment(first + b));
  upload(std::as_const(values).storage(), target);
}

}  // namespace moclean::opencl
