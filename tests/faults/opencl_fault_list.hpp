#pragma once

#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "faults/opencl_faults.hpp"

namespace moclean::test {

/// How a program or the library is asked to work on a small take.
struct OpenClWork {
  std::string name;
  std::vector<std::string> options;  ///< of `moclean denoise`
};

/// Every method on a device, in every form and precision; a loose tolerance keeps the list of calls
/// short.
inline const std::vector<OpenClWork>& opencl_works() {
  static const std::vector<OpenClWork> works = {
      {"Slra", {"--method", "slra", "--tolerance", "0.5"}},
      {"Rpca", {"--method", "rpca", "--tolerance", "0.5"}},
      {"SlraProfiled", {"--method", "slra", "--tolerance", "0.5", "--profile"}},
      {"SlraClblast", {"--method", "slra", "--tolerance", "0.5", "--products", "clblast"}},
      {"SlraForGpus", {"--method", "slra", "--tolerance", "0.5", "--form", "gpu"}},
      {"SlraMixed", {"--method", "slra", "--tolerance", "0.5", "--precision", "mixed"}},
      {"Tsvd", {"--method", "tsvd:rank=2"}},
      {"Svt", {"--method", "svt"}},
      {"Completion", {"--method", "completion:tolerance=0.5"}},
      {"Tslra", {"--method", "tslra:tolerance=0.5"}},
      {"TslraForGpus", {"--method", "tslra:tolerance=0.5", "--form", "gpu"}},
      {"Auto", {"--method", "auto"}},
      {"AutoForGpus", {"--method", "auto", "--form", "gpu"}}};
  return works;
}

/// One failure, as set_opencl_faults() and MOCLEAN_FAULT read it.
struct OpenClFaultCase {
  std::string function;
  std::string text;
};

/// What an error says of it; the C++ bindings do not know what they retain or release.
inline std::string named_in_messages(const OpenClFaultCase& fault) {
  for (const char* several : {"clRetain", "clRelease"})
    if (fault.function.starts_with(several)) return several;
  return fault.function == "any" ? "cl" : fault.function;
}

inline bool all_faults() {
  const char* wanted = std::getenv("MOCLEAN_FAULTS");
  return wanted && std::string_view(wanted) == "all";
}

/// Every n of `calls` of a function with every error it may return, once and from then on; up to
/// `most` of them, spread evenly.
inline std::vector<OpenClFaultCase> faults_of(const std::string& function, long calls, long most) {
  std::vector<OpenClFaultCase> all;
  const auto known = opencl_errors().find(function);
  if (known == opencl_errors().end()) return {{function, "unknown"}};
  for (long n = 1; n <= calls; ++n)
    for (const int code : known->second)
      for (const char* lasting : {"", "+"})
        all.push_back({function, fmt::format("{}:{}{}:{}", function, n, lasting, code)});
  const auto count = static_cast<long>(all.size());
  if (count <= most) return all;
  std::vector<OpenClFaultCase> some;  // not at the same error and mode every time
  for (long i = 0; i < most; ++i)
    some.push_back(all[static_cast<std::size_t>((2 * i + 1) * count / (2 * most))]);
  return some;
}

}  // namespace moclean::test
