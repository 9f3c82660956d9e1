#pragma once

#include <cstdlib>
#include <filesystem>
#include <functional>

#include <benchmark/benchmark.h>

namespace moclean::bench {

/// Where real takes lie: the variable MOCLEAN_DATA, else beside the checkout.
inline std::filesystem::path shared_data() {
  const char* place = std::getenv("MOCLEAN_DATA");
  return place ? std::filesystem::path(place)
               : std::filesystem::path(MOCLEAN_SOURCE_DIR).parent_path() / "shared" / "data";
}

/// Runs the benchmarks that a function registers, as the arguments of the program say. Returns its
/// exit code.
inline int run_benchmarks(int argc, char** argv, const std::function<void()>& add_all) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  add_all();
  benchmark::AddCustomContext("revision", MOCLEAN_REVISION);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace moclean::bench
