#include "moclean/linalg/peak.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdint>
#include <limits>

#include "moclean/device/kernel_source.hpp"
#include "moclean/linalg/batch.hpp"

namespace moclean {
namespace {

constexpr int repetitions = 5;

// Seconds of the fastest run, after one that is not counted.
template <class Run>
double least_seconds(const Device& device, const Run& run) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= repetitions; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    run();
    device.finish();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    if (i > 0) least = std::min(least, seconds.count());
  }
  return least;
}

// Work-items enough to fill a device, and few enough for a CPU to be done soon.
std::size_t items_of(const Device& device) {
  const std::size_t per_unit = device.info().kind == DeviceKind::gpu ? 2048 : 8;
  return per_unit * static_cast<std::size_t>(device.info().compute_units);
}

template <class Real>
double flops_per_second(const Device& device) {
  constexpr cl_int rounds = 50'000, sums = 12;
  const NumberType type = number_type<Real>;
  const Program program(device, kernel_source::peak, common_defines(device, type));
  Kernel multiply_add(program, "multiply_add");
  const std::size_t items = items_of(device);
  const auto width = static_cast<std::size_t>(vector_width(device, type));
  const Buffer<Real> sink(device, items * width);
  const Grid grid{.x = items, .group_x = items % 64 == 0 ? 64ul : 1ul};
  const double seconds =
      least_seconds(device, [&] { multiply_add(grid, rounds, Real(0.999), sink); });
  return 2.0 * rounds * sums * static_cast<double>(items * width) / seconds;
}

// Doubles to copy: 16 MiB on a CPU. A GPU has done that in the time of a launch, or has it all in
// its cache (50 MiB on an H100): up to 1 GiB there, a thirty-second of its memory.
std::size_t copied_size(const DeviceInfo& device) {
  constexpr std::uint64_t cpu = 16u << 20, gpu = 1u << 30;
  if (device.kind != DeviceKind::gpu) return cpu / sizeof(double);
  const std::uint64_t most = std::min({gpu, device.global_memory / 32, device.max_allocation});
  return static_cast<std::size_t>(std::max(cpu, std::bit_floor(most)) / sizeof(double));
}

double bytes_per_second(const Device& device) {
  const std::size_t size = copied_size(device.info());
  const Program program(device, kernel_source::peak, common_defines(device));
  Kernel copy(program, "copy");
  Buffer<double> source(device, size), target(device, size);
  source.fill_zero();
  const std::size_t items = items_of(device);
  const Grid grid{.x = items, .group_x = items % 64 == 0 ? 64ul : 1ul};
  const double seconds = least_seconds(device, [&] {
    copy(grid, static_cast<cl_int>(items), static_cast<cl_long>(size), source, target);
  });
  return 2.0 * static_cast<double>(size * sizeof(double)) / seconds;
}

}  // namespace

Peak measure_peak(const Device& device) {
  return {.double_flops = flops_per_second<double>(device),
          .float_flops = flops_per_second<float>(device),
          .bytes = bytes_per_second(device)};
}

}  // namespace moclean
