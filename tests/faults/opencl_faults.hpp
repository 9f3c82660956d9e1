#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace moclean::test {

/// Makes calls of OpenCL fail from now on, and counts from 0 again: `NAME:N:CODE`, the N-th call of
/// NAME (from 1) does nothing but return CODE; `NAME:N+:CODE`, so does every call from then on;
/// NAME `any` is all functions together, a device that is lost. Several are joined by commas; none
/// where empty.
void set_opencl_faults(std::string_view text);

/// Calls since then, by function; of all together as `any`.
std::map<std::string, long> opencl_calls();

/// How many of them failed on purpose.
long opencl_faults_injected();

/// The errors that the specification allows for a function (OpenCL 1.2 revision 19; what 3.0.14
/// adds), by its name. Not CL_DEVICE_NOT_FOUND and CL_PLATFORM_NOT_FOUND_KHR, which are answers.
const std::map<std::string, std::vector<int>>& opencl_errors();

}  // namespace moclean::test
