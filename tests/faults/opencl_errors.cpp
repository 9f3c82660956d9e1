// Chapters of the specification: 4.1 platforms, 4.2 devices, 4.4 contexts, 5.1 queues, 5.2 buffers,
// 5.5 memory objects, 5.6 programs (5.8 of 3.0), 5.7 kernels (5.9), 5.8 launches (5.10), 5.9 events
// (5.11), 5.12 profiling (5.14), 5.13 finish (5.15).

#define CL_TARGET_OPENCL_VERSION 300
#include <CL/cl.h>

#include "faults/opencl_faults.hpp"

namespace moclean::test {
namespace {

using Codes = std::vector<int>;

// Every function may fail for want of resources.
Codes and_resources(Codes codes) {
  codes.insert(codes.end(), {CL_OUT_OF_RESOURCES, CL_OUT_OF_HOST_MEMORY});
  return codes;
}

Codes of_enqueuing(const Codes& more) {
  Codes codes = and_resources({CL_INVALID_COMMAND_QUEUE, CL_INVALID_CONTEXT, CL_INVALID_OPERATION,
                               CL_INVALID_EVENT_WAIT_LIST, CL_MISALIGNED_SUB_BUFFER_OFFSET,
                               CL_MEM_OBJECT_ALLOCATION_FAILURE});
  codes.insert(codes.end(), more.begin(), more.end());
  return codes;
}

Codes of_a_transfer() {
  return of_enqueuing(
      {CL_INVALID_MEM_OBJECT, CL_INVALID_VALUE, CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST});
}

}  // namespace

const std::map<std::string, std::vector<int>>& opencl_errors() {
  static const std::map<std::string, std::vector<int>> errors = {
      {"clGetPlatformIDs", {CL_INVALID_VALUE, CL_OUT_OF_HOST_MEMORY}},
      {"clGetPlatformInfo", {CL_INVALID_PLATFORM, CL_INVALID_VALUE, CL_OUT_OF_HOST_MEMORY}},
      {"clGetDeviceIDs",
       and_resources({CL_INVALID_PLATFORM, CL_INVALID_DEVICE_TYPE, CL_INVALID_VALUE})},
      {"clGetDeviceInfo", and_resources({CL_INVALID_DEVICE, CL_INVALID_VALUE})},
      {"clRetainDevice", and_resources({CL_INVALID_DEVICE})},
      {"clReleaseDevice", and_resources({CL_INVALID_DEVICE})},
      {"clCreateContext", and_resources({CL_INVALID_PLATFORM, CL_INVALID_PROPERTY, CL_INVALID_VALUE,
                                         CL_INVALID_DEVICE, CL_DEVICE_NOT_AVAILABLE})},
      {"clRetainContext", and_resources({CL_INVALID_CONTEXT})},
      {"clReleaseContext", and_resources({CL_INVALID_CONTEXT})},
      {"clCreateCommandQueue", and_resources({CL_INVALID_CONTEXT, CL_INVALID_DEVICE,
                                              CL_INVALID_VALUE, CL_INVALID_QUEUE_PROPERTIES})},
      {"clGetCommandQueueInfo", and_resources({CL_INVALID_COMMAND_QUEUE, CL_INVALID_VALUE})},
      {"clReleaseCommandQueue", and_resources({CL_INVALID_COMMAND_QUEUE})},
      {"clCreateBuffer",
       and_resources({CL_INVALID_CONTEXT, CL_INVALID_VALUE, CL_INVALID_BUFFER_SIZE,
                      CL_INVALID_HOST_PTR, CL_MEM_OBJECT_ALLOCATION_FAILURE})},
      {"clGetMemObjectInfo", and_resources({CL_INVALID_MEM_OBJECT, CL_INVALID_VALUE})},
      {"clRetainMemObject", and_resources({CL_INVALID_MEM_OBJECT})},
      {"clReleaseMemObject", and_resources({CL_INVALID_MEM_OBJECT})},
      {"clCreateProgramWithSource", and_resources({CL_INVALID_CONTEXT, CL_INVALID_VALUE})},
      {"clCreateProgramWithBinary",
       and_resources({CL_INVALID_CONTEXT, CL_INVALID_VALUE, CL_INVALID_DEVICE, CL_INVALID_BINARY})},
      {"clBuildProgram",
       and_resources({CL_INVALID_PROGRAM, CL_INVALID_VALUE, CL_INVALID_DEVICE, CL_INVALID_BINARY,
                      CL_INVALID_BUILD_OPTIONS, CL_COMPILER_NOT_AVAILABLE, CL_BUILD_PROGRAM_FAILURE,
                      CL_INVALID_OPERATION})},
      {"clGetProgramInfo",
       and_resources({CL_INVALID_VALUE, CL_INVALID_PROGRAM, CL_INVALID_PROGRAM_EXECUTABLE})},
      {"clGetProgramBuildInfo",
       and_resources({CL_INVALID_DEVICE, CL_INVALID_VALUE, CL_INVALID_PROGRAM})},
      {"clRetainProgram", and_resources({CL_INVALID_PROGRAM})},
      {"clReleaseProgram", and_resources({CL_INVALID_PROGRAM})},
      {"clCreateKernel",
       and_resources({CL_INVALID_PROGRAM, CL_INVALID_PROGRAM_EXECUTABLE, CL_INVALID_KERNEL_NAME,
                      CL_INVALID_KERNEL_DEFINITION, CL_INVALID_VALUE})},
      {"clSetKernelArg",
       and_resources({CL_INVALID_KERNEL, CL_INVALID_ARG_INDEX, CL_INVALID_ARG_VALUE,
                      CL_INVALID_MEM_OBJECT, CL_INVALID_SAMPLER, CL_INVALID_DEVICE_QUEUE,
                      CL_INVALID_ARG_SIZE, CL_MAX_SIZE_RESTRICTION_EXCEEDED})},
      {"clGetKernelWorkGroupInfo",
       and_resources({CL_INVALID_DEVICE, CL_INVALID_VALUE, CL_INVALID_KERNEL})},
      {"clReleaseKernel", and_resources({CL_INVALID_KERNEL})},
      {"clEnqueueNDRangeKernel",
       of_enqueuing({CL_INVALID_PROGRAM_EXECUTABLE, CL_INVALID_KERNEL, CL_INVALID_KERNEL_ARGS,
                     CL_INVALID_WORK_DIMENSION, CL_INVALID_GLOBAL_WORK_SIZE,
                     CL_INVALID_GLOBAL_OFFSET, CL_INVALID_WORK_GROUP_SIZE,
                     CL_INVALID_WORK_ITEM_SIZE, CL_INVALID_IMAGE_SIZE,
                     CL_IMAGE_FORMAT_NOT_SUPPORTED})},
      {"clEnqueueReadBuffer", of_a_transfer()},
      {"clEnqueueWriteBuffer", of_a_transfer()},
      {"clEnqueueCopyBuffer",
       of_enqueuing({CL_INVALID_MEM_OBJECT, CL_INVALID_VALUE, CL_MEM_COPY_OVERLAP})},
      {"clFinish", and_resources({CL_INVALID_COMMAND_QUEUE})},
      {"clWaitForEvents", and_resources({CL_INVALID_VALUE, CL_INVALID_CONTEXT, CL_INVALID_EVENT,
                                         CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST})},
      {"clGetEventInfo", and_resources({CL_INVALID_EVENT, CL_INVALID_VALUE})},
      {"clGetEventProfilingInfo",
       and_resources({CL_PROFILING_INFO_NOT_AVAILABLE, CL_INVALID_EVENT, CL_INVALID_VALUE})},
      {"clRetainEvent", and_resources({CL_INVALID_EVENT})},
      {"clReleaseEvent", and_resources({CL_INVALID_EVENT})},
      // A lost device: whatever is called next.
      {"any", {CL_OUT_OF_RESOURCES, CL_DEVICE_NOT_AVAILABLE}}};
  return errors;
}

}  // namespace moclean::test
