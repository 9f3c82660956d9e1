// The entry of libFuzzer into the target MOCLEAN_FUZZ_TARGET.

#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "fuzz/target.hpp"
#include "fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    moclean::fuzz::MOCLEAN_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
  } catch (const moclean::fuzz::Violation& violation) {
    std::fprintf(stderr, "violation: %s\n", violation.what());
    std::abort();
  }
  return 0;
}
