#include "moclean/device/kernel.hpp"

#include <utility>

#include <fmt/format.h>

#include "moclean/device/kernel_source.hpp"

namespace moclean {
namespace {

std::string options_of(const Defines& defines) {
  std::string options = "-cl-std=CL1.2 -w";  // the test kernels_compile has warnings as errors
  for (const auto& [name, value] : defines) options += fmt::format(" -D{}={}", name, value);
  return options;
}

std::size_t whole_groups(std::size_t items, std::size_t group) {
  return (items + group - 1) / group * group;
}

// What the compiler says; a driver may have nothing, or not be able to tell it.
std::string log_of(const cl::Program& program, const Device& device) {
  try {
    std::string log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.handle());
    return log.find_first_not_of(" \n") == log.npos ? "(no log)" : log;
  } catch (const cl::Error& error) {
    return fmt::format("(no log: {} returned {})", error.what(), opencl_status(error.err()));
  }
}

// Not cl::Program::build(), which asks for the log of what was built, too, and takes a failure of
// that for one of the compiler.
cl::Program build(const Device& device, const std::string& text, const std::string& options) {
  cl::Program program(device.context(), text);
  const cl_device_id target = device.handle()();
  const cl_int status = clBuildProgram(program(), 1, &target, options.c_str(), nullptr, nullptr);
  if (status != CL_SUCCESS)
    throw DeviceError(
        fmt::format("OpenCL compiler of {} failed (clBuildProgram returned {}) with "
                    "options {}:\n{}",
                    device.info().name, opencl_status(status), options, log_of(program, device)));
  return program;
}

}  // namespace

Program::Program(const Device& device, std::string_view source, const Defines& defines)
    : device_(&device) {
  const std::string options = options_of(defines);
  const std::string text = std::string(kernel_source::prelude) + std::string(source);
  translate_opencl_errors("to load a program on " + device.info().name, [&] {
    program_ = device.programs().find_or_build(options + '\n' + text,
                                               [&] { return build(device, text, options); });
  });
}

Kernel::Kernel(const Program& program, const std::string& name)
    : device_(&program.device()), name_(name) {
  translate_opencl_errors("to find kernel " + name,
                          [&] { kernel_ = cl::Kernel(program.handle(), name.c_str()); });
}

std::size_t Kernel::largest_group() const {
  return translate_opencl_errors("to query kernel " + name_ + " on " + device_->info().name, [&] {
    return kernel_.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device_->handle());
  });
}

void Kernel::launch(const Grid& grid) {
  const std::optional<Work> work = std::exchange(work_, std::nullopt);
  if (grid.x == 0 || grid.y == 0 || grid.z == 0) return;
  cl::Event event;
  Profile* const profile = device_->profile();
  translate_opencl_errors("to run kernel " + name_ + " on " + device_->info().name, [&] {
    device_->queue().enqueueNDRangeKernel(
        kernel_, cl::NullRange, cl::NDRange(whole_groups(grid.x, grid.group_x), grid.y, grid.z),
        cl::NDRange(grid.group_x, 1, 1), nullptr, profile ? &event : nullptr);
  });
  if (profile) profile->record(name_, std::move(event), work);
}

}  // namespace moclean
