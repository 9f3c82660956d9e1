#include "moclean/device/device.hpp"

#include <algorithm>
#include <charconv>
#include <tuple>

#include <fmt/format.h>

namespace moclean {
namespace {

DeviceKind kind_of(const cl::Device& device) {
  const auto type = device.getInfo<CL_DEVICE_TYPE>();
  if (type & CL_DEVICE_TYPE_GPU) return DeviceKind::gpu;
  if (type & CL_DEVICE_TYPE_CPU) return DeviceKind::cpu;
  return DeviceKind::other;
}

DeviceInfo info_of(const cl::Platform& platform, const cl::Device& device) {
  DeviceInfo info;
  info.name = device.getInfo<CL_DEVICE_NAME>();
  info.platform_name = platform.getInfo<CL_PLATFORM_NAME>();
  info.driver = device.getInfo<CL_DRIVER_VERSION>();
  info.version = device.getInfo<CL_DEVICE_VERSION>();
  info.kind = kind_of(device);
  info.fp64 = device.getInfo<CL_DEVICE_DOUBLE_FP_CONFIG>() != 0;
  info.compute_units = static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
  info.vector_width =
      std::max(1, static_cast<int>(device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_DOUBLE>()));
  info.global_memory = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  info.global_cache = device.getInfo<CL_DEVICE_GLOBAL_MEM_CACHE_SIZE>();
  info.max_allocation = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  info.local_memory = device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
  info.max_work_group = device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
  return info;
}

struct Candidate {
  DeviceInfo info;
  cl::Device device;
};

// What there is, and of platforms that could not tell theirs, why.
struct Candidates {
  std::vector<Candidate> found;
  std::string problems;
};

// The ICD loader reports "no platform" and "no device" as errors; to us both are empty lists.
std::vector<cl::Platform> platforms() {
  std::vector<cl::Platform> found;
  try {
    cl::Platform::get(&found);
  } catch (const cl::Error& error) {
    constexpr cl_int none = -1001;  // CL_PLATFORM_NOT_FOUND_KHR
    if (error.err() != none) throw;
    found.clear();
  }
  return found;
}

std::vector<cl::Device> devices_of(const cl::Platform& platform) {
  std::vector<cl::Device> found;
  try {
    platform.getDevices(CL_DEVICE_TYPE_ALL, &found);
  } catch (const cl::Error& error) {
    if (error.err() != CL_DEVICE_NOT_FOUND) throw;
    found.clear();
  }
  return found;
}

void add_candidates(const cl::Platform& platform, int platform_index, std::vector<Candidate>& all) {
  int index = 0;
  for (const auto& device : devices_of(platform)) {
    Candidate candidate{info_of(platform, device), device};
    candidate.info.platform = platform_index;
    candidate.info.index = index++;
    all.push_back(std::move(candidate));
  }
}

// A driver that is broken must not take the others' devices away.
Candidates candidates() {
  Candidates all;
  int platform_index = 0;
  for (const auto& platform : platforms()) {
    try {
      add_candidates(platform, platform_index, all.found);
    } catch (const cl::Error& error) {
      all.problems +=
          fmt::format("{}platform {}: {} returned {}", all.problems.empty() ? "" : ", ",
                      platform_index, opencl_function(error.what()), opencl_status(error.err()));
    }
    ++platform_index;
  }
  if (all.found.empty() && !all.problems.empty())
    throw DeviceError("OpenCL failed to list the devices of " + all.problems);
  return all;
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

bool is_index_pair(std::string_view text) {
  const auto colon = text.find(':');
  return colon != text.npos && colon > 0 && colon + 1 < text.size() &&
         text.find_first_not_of("0123456789:") == text.npos;
}

bool matches(const DeviceInfo& info, const std::string& wanted) {
  if (wanted.empty()) return true;
  if (wanted == "cpu") return info.kind == DeviceKind::cpu;
  if (wanted == "gpu") return info.kind == DeviceKind::gpu;
  if (is_index_pair(wanted)) return wanted == fmt::format("{}:{}", info.platform, info.index);
  return lower(info.name).find(wanted) != std::string::npos ||
         lower(info.platform_name).find(wanted) != std::string::npos;
}

Candidate choose(std::string_view selection) {
  const auto [all, problems] = candidates();
  const auto better = [](const Candidate& a, const Candidate& b) {
    const auto score = [](const DeviceInfo& i) {
      return std::tuple(i.fp64, i.kind == DeviceKind::gpu, i.kind == DeviceKind::cpu);
    };
    return score(a.info) > score(b.info);
  };
  const Candidate* best = nullptr;
  for (const auto& candidate : all)
    if (matches(candidate.info, lower(selection)) && (!best || better(candidate, *best)))
      best = &candidate;
  if (best) return *best;

  if (all.empty())
    throw DeviceError("no OpenCL device found; install a driver, for a CPU pocl-opencl-icd");
  std::string found;
  for (const auto& candidate : all) found += (found.empty() ? "" : ", ") + describe(candidate.info);
  if (!problems.empty()) found += "; failed: " + problems;
  throw DeviceError(fmt::format("no OpenCL device matches '{}' (found: {})", selection, found));
}

cl::CommandQueue queue_of(const cl::Context& context, const cl::Device& device,
                          const Profile* profile) {
  return {context, device, profile ? CL_QUEUE_PROFILING_ENABLE : cl_command_queue_properties{0}};
}

}  // namespace

std::string to_string(DeviceKind kind) {
  switch (kind) {
    case DeviceKind::cpu:
      return "cpu";
    case DeviceKind::gpu:
      return "gpu";
    case DeviceKind::other:
      break;
  }
  return "other";
}

std::vector<DeviceInfo> list_devices() {
  return translate_opencl_errors("to list the devices", [] {
    std::vector<DeviceInfo> infos;
    for (auto& candidate : candidates().found) infos.push_back(std::move(candidate.info));
    return infos;
  });
}

std::string describe(const DeviceInfo& info) {
  return fmt::format("{}:{} {} ({}, {} units, {:.1f} GiB, {})", info.platform, info.index,
                     info.name, to_string(info.kind), info.compute_units,
                     static_cast<double>(info.global_memory) / (1ull << 30),
                     info.fp64 ? "fp64" : "no fp64");
}

Device::Device(std::string_view selection, Profiling profiling)
    : own_profile_(profiling == Profiling::on ? std::make_unique<Profile>() : nullptr),
      own_programs_(std::make_unique<BuiltPrograms>()),
      profile_(own_profile_.get()),
      programs_(own_programs_.get()) {
  translate_opencl_errors("to open the device", [&] {
    Candidate chosen = choose(selection);
    info_ = std::move(chosen.info);
    device_ = chosen.device;
    context_ = cl::Context(device_);
    queue_ = queue_of(context_, device_, profile_);
  });
}

Device::Device(const Device& first, AnotherQueue)
    : info_(first.info_),
      device_(first.device_),
      context_(first.context_),
      profile_(first.profile_),
      programs_(first.programs_) {
  translate_opencl_errors("to make another queue on " + info_.name,
                          [&] { queue_ = queue_of(context_, device_, profile_); });
}

void Device::finish() const {
  translate_opencl_errors("on " + info_.name, [&] { queue_.finish(); });
}

}  // namespace moclean
