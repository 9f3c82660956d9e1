// Robust PCA of a batch: backend x segments x frames per segment x columns. Every configuration is
// checked against the reference before it is timed. For quotable figures:
//   build/bench/solve_bench --benchmark_repetitions=5 --benchmark_enable_random_interleaving=true
//     --benchmark_report_aggregates_only=true --benchmark_out=solve.json
#include <cstdlib>
#include <memory>

#include <benchmark/benchmark.h>

#include "moclean/backend/opencl_backend.hpp"
#include "moclean/noise/motion_like.hpp"

#include "support/verify.hpp"

namespace moclean::bench {
namespace {

constexpr int threads = 2;

enum class Contestant { opencl_own, opencl_clblast, reference };

const Device& device() {
  static const char* selection = std::getenv("MOCLEAN_DEVICE");
  static const Device* opened = new Device(selection ? selection : "");
  return *opened;
}

std::unique_ptr<Backend> make(Contestant contestant) {
  if (contestant == Contestant::reference) return std::make_unique<ReferenceBackend>(threads);
  const auto products =
      contestant == Contestant::opencl_own ? ProductPath::own : ProductPath::clblast;
  return std::make_unique<OpenClBackend>(device(), OpenClOptions{.products = products});
}

void solve(benchmark::State& state, Contestant contestant) {
  const Index segments = state.range(0), frames = state.range(1), columns = state.range(2);
  const SegmentBatch data = motion_like(segments, frames, columns);
  const RobustPca method;
  const auto backend = make(contestant);
  const Solution first = backend->solve(data, method);
  if (const std::string wrong = disagreement(data, first, method); !wrong.empty()) {
    state.SkipWithError(wrong.c_str());
    return;
  }

  for (auto iteration : state) benchmark::DoNotOptimize(backend->solve(data, method));

  const auto total = static_cast<double>(state.iterations() * segments);
  using benchmark::Counter;
  state.counters["segments/s"] = Counter(total, Counter::kIsRate);
  state.counters["frames/s"] = Counter(total * static_cast<double>(frames), Counter::kIsRate);
  state.counters["iterations"] = first.segments[0].iterations;
  state.counters["rank"] = first.segments[0].rank;
}

// Two whole axes and their crossing point rather than the full product, which would take an hour.
void axes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"segments", "frames", "columns"})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->MinTime(0.5);
  for (const int segments : {1, 8, 32, 128}) bench->Args({segments, 200, 93});
  for (const int frames : {25, 100, 400, 1000}) bench->Args({16, frames, 93});
  for (const int columns : {9, 63, 204, 300}) bench->Args({16, 200, columns});
}

BENCHMARK_CAPTURE(solve, opencl, Contestant::opencl_own)->Apply(axes);
BENCHMARK_CAPTURE(solve, opencl_clblast, Contestant::opencl_clblast)->Apply(axes);
BENCHMARK_CAPTURE(solve, reference, Contestant::reference)->Apply(axes);

}  // namespace
}  // namespace moclean::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  const auto& info = moclean::bench::device().info();
  benchmark::AddCustomContext("device", info.name);
  benchmark::AddCustomContext("platform", info.platform_name);
  benchmark::AddCustomContext("driver", info.driver);
  benchmark::AddCustomContext("revision", MOCLEAN_REVISION);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
