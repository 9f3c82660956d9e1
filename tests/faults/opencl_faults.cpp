// Stands between a program and the OpenCL loader and makes calls fail: linked into a test, or
// loaded before all other libraries (LD_PRELOAD), where the environment tells which:
//   MOCLEAN_FAULT=NAME:N:CODE,...   as in the header
//   MOCLEAN_FAULT_CALLS=FILE        gets a line per function, `NAME CALLS`, at the end
// The calls of CLBlast come here, too; those of a driver within itself do not.

#include "faults/opencl_faults.hpp"

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <type_traits>

#include <dlfcn.h>

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

namespace moclean::test {
namespace {

struct Fault {
  std::string function;
  long first = 0;
  bool lasting = false;
  cl_int code = 0;
};

// Never destroyed: drivers call when the process ends.
struct State {
  std::mutex mutex;
  std::vector<Fault> faults;
  std::map<std::string, long> calls;
  long injected = 0;
};

State& state() {
  static auto* const only = new State;
  return *only;
}

Fault parse_fault(const std::string& text) {
  const std::size_t colon = text.find(':');
  Fault fault{.function = text.substr(0, colon)};
  if (colon == text.npos) return fault;
  char* rest = nullptr;
  fault.first = std::strtol(text.c_str() + colon + 1, &rest, 10);
  fault.lasting = *rest == '+';
  if (fault.lasting) ++rest;
  fault.code = *rest == ':' ? std::atoi(rest + 1) : CL_OUT_OF_RESOURCES;
  return fault;
}

// CL_SUCCESS, or what a call has to return.
cl_int fault_of(const char* function) {
  State& now = state();
  const std::lock_guard lock(now.mutex);
  const long call = ++now.calls[function], of_all = ++now.calls["any"];
  for (const Fault& fault : now.faults) {
    const bool any = fault.function == "any";
    if (!any && fault.function != function) continue;
    const long n = any ? of_all : call;
    if (fault.first == 0 || n < fault.first || (n > fault.first && !fault.lasting)) continue;
    ++now.injected;
    return fault.code;
  }
  return CL_SUCCESS;
}

// What makes an object tells its error through the last argument.
template <class First, class... Rest>
void tell(cl_int code, First first, Rest... rest) {
  if constexpr (sizeof...(rest) > 0)
    tell(code, rest...);
  else if constexpr (std::is_same_v<First, cl_int*>)
    if (first) *first = code;
}

template <class Result, class... Arguments>
Result forward(const char* name, Arguments... arguments) {
  if (const cl_int code = fault_of(name)) {
    if constexpr (std::is_pointer_v<Result>) {
      tell(code, arguments...);
      return nullptr;
    } else {
      return code;
    }
  }
  const auto next = reinterpret_cast<Result (*)(Arguments...)>(dlsym(RTLD_NEXT, name));
  return next(arguments...);
}

struct Environment {
  Environment() {
    if (const char* text = std::getenv("MOCLEAN_FAULT")) set_opencl_faults(text);
  }
  ~Environment() {
    const char* file = std::getenv("MOCLEAN_FAULT_CALLS");
    std::FILE* const out = file ? std::fopen(file, "w") : nullptr;
    if (!out) return;
    for (const auto& [name, calls] : opencl_calls())
      std::fprintf(out, "%s %ld\n", name.c_str(), calls);
    std::fclose(out);
  }
} environment_of_the_process;

}  // namespace

void set_opencl_faults(std::string_view text) {
  State& now = state();
  const std::lock_guard lock(now.mutex);
  now.faults.clear();
  now.calls.clear();
  now.injected = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    now.faults.push_back(parse_fault(std::string(text.substr(begin, end - begin))));
    begin = end + 1;
  }
}

std::map<std::string, long> opencl_calls() {
  State& now = state();
  const std::lock_guard lock(now.mutex);
  return now.calls;
}

long opencl_faults_injected() {
  State& now = state();
  const std::lock_guard lock(now.mutex);
  return now.injected;
}

}  // namespace moclean::test

// A function with the signature of the specification; a template cannot have its name.
#define MOCLEAN_SHIM(Result, name, parameters, ...) \
  Result name parameters { return moclean::test::forward<Result>(#name, __VA_ARGS__); }

#define MOCLEAN_SHIM_OF_OBJECT(name, Object) MOCLEAN_SHIM(cl_int, name, (Object object), object)

#define MOCLEAN_SHIM_OF_QUERY(name, Object, Info)                                                 \
  MOCLEAN_SHIM(cl_int, name,                                                                      \
               (Object object, Info what, size_t size, void* value, size_t* actual_size), object, \
               what, size, value, actual_size)

#define MOCLEAN_SHIM_OF_TRANSFER(name, Memory)                                              \
  MOCLEAN_SHIM(                                                                             \
      cl_int, name,                                                                         \
      (cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size, \
       Memory memory, cl_uint count, const cl_event* wait_for, cl_event* event),            \
      queue, buffer, blocking, offset, size, memory, count, wait_for, event)

extern "C" {

MOCLEAN_SHIM(cl_int, clGetPlatformIDs, (cl_uint room, cl_platform_id* ids, cl_uint* count), room,
             ids, count)
MOCLEAN_SHIM(cl_int, clGetDeviceIDs,
             (cl_platform_id platform, cl_device_type type, cl_uint room, cl_device_id* ids,
              cl_uint* count),
             platform, type, room, ids, count)
MOCLEAN_SHIM_OF_QUERY(clGetPlatformInfo, cl_platform_id, cl_platform_info)
MOCLEAN_SHIM_OF_QUERY(clGetDeviceInfo, cl_device_id, cl_device_info)
MOCLEAN_SHIM_OF_OBJECT(clRetainDevice, cl_device_id)
MOCLEAN_SHIM_OF_OBJECT(clReleaseDevice, cl_device_id)

using ContextCallback = void(const char*, const void*, size_t, void*);
MOCLEAN_SHIM(cl_context, clCreateContext,
             (const cl_context_properties* properties, cl_uint count, const cl_device_id* devices,
              ContextCallback* notify, void* data, cl_int* error),
             properties, count, devices, notify, data, error)
MOCLEAN_SHIM_OF_OBJECT(clRetainContext, cl_context)
MOCLEAN_SHIM_OF_OBJECT(clReleaseContext, cl_context)

MOCLEAN_SHIM(cl_command_queue, clCreateCommandQueue,
             (cl_context context, cl_device_id device, cl_command_queue_properties properties,
              cl_int* error),
             context, device, properties, error)
MOCLEAN_SHIM_OF_QUERY(clGetCommandQueueInfo, cl_command_queue, cl_command_queue_info)
MOCLEAN_SHIM_OF_OBJECT(clReleaseCommandQueue, cl_command_queue)
MOCLEAN_SHIM_OF_OBJECT(clFinish, cl_command_queue)

MOCLEAN_SHIM(cl_mem, clCreateBuffer,
             (cl_context context, cl_mem_flags flags, size_t size, void* memory, cl_int* error),
             context, flags, size, memory, error)
MOCLEAN_SHIM_OF_QUERY(clGetMemObjectInfo, cl_mem, cl_mem_info)
MOCLEAN_SHIM_OF_OBJECT(clRetainMemObject, cl_mem)
MOCLEAN_SHIM_OF_OBJECT(clReleaseMemObject, cl_mem)
MOCLEAN_SHIM_OF_TRANSFER(clEnqueueReadBuffer, void*)
MOCLEAN_SHIM_OF_TRANSFER(clEnqueueWriteBuffer, const void*)
MOCLEAN_SHIM(cl_int, clEnqueueCopyBuffer,
             (cl_command_queue queue, cl_mem source, cl_mem target, size_t source_offset,
              size_t target_offset, size_t size, cl_uint count, const cl_event* wait_for,
              cl_event* event),
             queue, source, target, source_offset, target_offset, size, count, wait_for, event)

using ProgramCallback = void(cl_program, void*);
MOCLEAN_SHIM(cl_program, clCreateProgramWithSource,
             (cl_context context, cl_uint count, const char** texts, const size_t* lengths,
              cl_int* error),
             context, count, texts, lengths, error)
MOCLEAN_SHIM(cl_program, clCreateProgramWithBinary,
             (cl_context context, cl_uint count, const cl_device_id* devices, const size_t* lengths,
              const unsigned char** binaries, cl_int* status, cl_int* error),
             context, count, devices, lengths, binaries, status, error)
MOCLEAN_SHIM(cl_int, clBuildProgram,
             (cl_program program, cl_uint count, const cl_device_id* devices, const char* options,
              ProgramCallback* notify, void* data),
             program, count, devices, options, notify, data)
MOCLEAN_SHIM_OF_QUERY(clGetProgramInfo, cl_program, cl_program_info)
MOCLEAN_SHIM(cl_int, clGetProgramBuildInfo,
             (cl_program program, cl_device_id device, cl_program_build_info what, size_t size,
              void* value, size_t* actual_size),
             program, device, what, size, value, actual_size)
MOCLEAN_SHIM_OF_OBJECT(clRetainProgram, cl_program)
MOCLEAN_SHIM_OF_OBJECT(clReleaseProgram, cl_program)

MOCLEAN_SHIM(cl_kernel, clCreateKernel, (cl_program program, const char* name, cl_int* error),
             program, name, error)
MOCLEAN_SHIM(cl_int, clSetKernelArg,
             (cl_kernel kernel, cl_uint index, size_t size, const void* value), kernel, index, size,
             value)
MOCLEAN_SHIM(cl_int, clGetKernelWorkGroupInfo,
             (cl_kernel kernel, cl_device_id device, cl_kernel_work_group_info what, size_t size,
              void* value, size_t* actual_size),
             kernel, device, what, size, value, actual_size)
MOCLEAN_SHIM_OF_OBJECT(clReleaseKernel, cl_kernel)
MOCLEAN_SHIM(cl_int, clEnqueueNDRangeKernel,
             (cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t* offset,
              const size_t* global, const size_t* local, cl_uint count, const cl_event* wait_for,
              cl_event* event),
             queue, kernel, dimensions, offset, global, local, count, wait_for, event)

MOCLEAN_SHIM(cl_int, clWaitForEvents, (cl_uint count, const cl_event* events), count, events)
MOCLEAN_SHIM_OF_QUERY(clGetEventInfo, cl_event, cl_event_info)
MOCLEAN_SHIM_OF_QUERY(clGetEventProfilingInfo, cl_event, cl_profiling_info)
MOCLEAN_SHIM_OF_OBJECT(clRetainEvent, cl_event)
MOCLEAN_SHIM_OF_OBJECT(clReleaseEvent, cl_event)

}  // extern "C"
