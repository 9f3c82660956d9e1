#include "moclean/device/opencl.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace moclean {
namespace {

struct Status {
  cl_int code;
  const char* name;
};

#define MOCLEAN_STATUS(code) \
  Status { code, #code }

// All of OpenCL 1.2, those that later versions add to functions of 1.2, and that of the loader.
constexpr std::array statuses = {MOCLEAN_STATUS(CL_DEVICE_NOT_FOUND),
                                 MOCLEAN_STATUS(CL_DEVICE_NOT_AVAILABLE),
                                 MOCLEAN_STATUS(CL_COMPILER_NOT_AVAILABLE),
                                 MOCLEAN_STATUS(CL_MEM_OBJECT_ALLOCATION_FAILURE),
                                 MOCLEAN_STATUS(CL_OUT_OF_RESOURCES),
                                 MOCLEAN_STATUS(CL_OUT_OF_HOST_MEMORY),
                                 MOCLEAN_STATUS(CL_PROFILING_INFO_NOT_AVAILABLE),
                                 MOCLEAN_STATUS(CL_MEM_COPY_OVERLAP),
                                 MOCLEAN_STATUS(CL_IMAGE_FORMAT_MISMATCH),
                                 MOCLEAN_STATUS(CL_IMAGE_FORMAT_NOT_SUPPORTED),
                                 MOCLEAN_STATUS(CL_BUILD_PROGRAM_FAILURE),
                                 MOCLEAN_STATUS(CL_MAP_FAILURE),
                                 MOCLEAN_STATUS(CL_MISALIGNED_SUB_BUFFER_OFFSET),
                                 MOCLEAN_STATUS(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST),
                                 MOCLEAN_STATUS(CL_COMPILE_PROGRAM_FAILURE),
                                 MOCLEAN_STATUS(CL_LINKER_NOT_AVAILABLE),
                                 MOCLEAN_STATUS(CL_LINK_PROGRAM_FAILURE),
                                 MOCLEAN_STATUS(CL_DEVICE_PARTITION_FAILED),
                                 MOCLEAN_STATUS(CL_KERNEL_ARG_INFO_NOT_AVAILABLE),
                                 MOCLEAN_STATUS(CL_INVALID_VALUE),
                                 MOCLEAN_STATUS(CL_INVALID_DEVICE_TYPE),
                                 MOCLEAN_STATUS(CL_INVALID_PLATFORM),
                                 MOCLEAN_STATUS(CL_INVALID_DEVICE),
                                 MOCLEAN_STATUS(CL_INVALID_CONTEXT),
                                 MOCLEAN_STATUS(CL_INVALID_QUEUE_PROPERTIES),
                                 MOCLEAN_STATUS(CL_INVALID_COMMAND_QUEUE),
                                 MOCLEAN_STATUS(CL_INVALID_HOST_PTR),
                                 MOCLEAN_STATUS(CL_INVALID_MEM_OBJECT),
                                 MOCLEAN_STATUS(CL_INVALID_IMAGE_FORMAT_DESCRIPTOR),
                                 MOCLEAN_STATUS(CL_INVALID_IMAGE_SIZE),
                                 MOCLEAN_STATUS(CL_INVALID_SAMPLER),
                                 MOCLEAN_STATUS(CL_INVALID_BINARY),
                                 MOCLEAN_STATUS(CL_INVALID_BUILD_OPTIONS),
                                 MOCLEAN_STATUS(CL_INVALID_PROGRAM),
                                 MOCLEAN_STATUS(CL_INVALID_PROGRAM_EXECUTABLE),
                                 MOCLEAN_STATUS(CL_INVALID_KERNEL_NAME),
                                 MOCLEAN_STATUS(CL_INVALID_KERNEL_DEFINITION),
                                 MOCLEAN_STATUS(CL_INVALID_KERNEL),
                                 MOCLEAN_STATUS(CL_INVALID_ARG_INDEX),
                                 MOCLEAN_STATUS(CL_INVALID_ARG_VALUE),
                                 MOCLEAN_STATUS(CL_INVALID_ARG_SIZE),
                                 MOCLEAN_STATUS(CL_INVALID_KERNEL_ARGS),
                                 MOCLEAN_STATUS(CL_INVALID_WORK_DIMENSION),
                                 MOCLEAN_STATUS(CL_INVALID_WORK_GROUP_SIZE),
                                 MOCLEAN_STATUS(CL_INVALID_WORK_ITEM_SIZE),
                                 MOCLEAN_STATUS(CL_INVALID_GLOBAL_OFFSET),
                                 MOCLEAN_STATUS(CL_INVALID_EVENT_WAIT_LIST),
                                 MOCLEAN_STATUS(CL_INVALID_EVENT),
                                 MOCLEAN_STATUS(CL_INVALID_OPERATION),
                                 MOCLEAN_STATUS(CL_INVALID_GL_OBJECT),
                                 MOCLEAN_STATUS(CL_INVALID_BUFFER_SIZE),
                                 MOCLEAN_STATUS(CL_INVALID_MIP_LEVEL),
                                 MOCLEAN_STATUS(CL_INVALID_GLOBAL_WORK_SIZE),
                                 MOCLEAN_STATUS(CL_INVALID_PROPERTY),
                                 MOCLEAN_STATUS(CL_INVALID_IMAGE_DESCRIPTOR),
                                 MOCLEAN_STATUS(CL_INVALID_COMPILER_OPTIONS),
                                 MOCLEAN_STATUS(CL_INVALID_LINKER_OPTIONS),
                                 MOCLEAN_STATUS(CL_INVALID_DEVICE_PARTITION_COUNT),
                                 Status{-69, "CL_INVALID_PIPE_SIZE"},
                                 Status{-70, "CL_INVALID_DEVICE_QUEUE"},
                                 Status{-71, "CL_INVALID_SPEC_ID"},
                                 Status{-72, "CL_MAX_SIZE_RESTRICTION_EXCEEDED"},
                                 Status{-1001, "CL_PLATFORM_NOT_FOUND_KHR"}};

}  // namespace

std::string opencl_status(cl_int status) {
  const auto known = std::ranges::find(statuses, status, &Status::code);
  return known != statuses.end() ? known->name : "OpenCL status " + std::to_string(status);
}

std::string opencl_function(const char* name) {
  const std::string_view given = name;
  if (given == "Retain Object") return "a clRetain function";
  if (given == "Release Object") return "a clRelease function";
  if (given == "clGetEventProfileInfo") return "clGetEventProfilingInfo";
  return name;
}

}  // namespace moclean
