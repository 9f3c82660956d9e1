// The sections that let solvers compete on batches, all within this process.
#include <fmt/format.h>

#include "moclean/noise/motion_like.hpp"

#include "suite/answer.hpp"
#include "suite/contest.hpp"
#include "suite/sections.hpp"
#include "suite/statistics.hpp"

namespace moclean::bench {
namespace {

using nlohmann::json;

Workload synthetic(Index segments, Index frames, Index columns) {
  return {fmt::format("{} x {} x {}", segments, frames, columns),
          motion_like(segments, frames, columns)};
}

/// moclean and the strongest form of each peer.
std::vector<Contestant> finalists(const Settings& settings, const Device& device) {
  std::vector<Contestant> contestants;
  contestants.push_back(opencl(device));
  contestants.push_back(lapack(settings.threads));
  contestants.push_back(eigen(settings.threads));
  return contestants;
}

json first_take(const Settings& settings, const std::vector<Contestant>& contestants) {
  const NoisyTake take = noisy_takes(settings.data).front();
  json contests;
  for (const Index length : {200, 400})
    contests.push_back(contest(cut_into_segments(take, length), contestants, settings.repetitions));
  return contests;
}

}  // namespace

json measure_takes(const Settings& settings, const Device& device) {
  const auto contestants = everyone(device, settings.threads);
  const std::vector<Index> lengths =
      settings.quick ? std::vector<Index>{200, 400} : std::vector<Index>{100, 200, 400, 1000, 0};
  json contests;
  for (const NoisyTake& take : noisy_takes(settings.data))
    for (const Index length : lengths)
      contests.push_back(
          contest(cut_into_segments(take, length), contestants, settings.repetitions));
  return contests;
}

json measure_segments(const Settings& settings, const Device& device) {
  const auto contestants = finalists(settings, device);
  json contests;
  for (const Index segments : {1, 4, 16, 32, 64, 256})
    if (!settings.quick || segments <= 64)
      contests.push_back(contest(synthetic(segments, 200, 93), contestants, settings.repetitions));
  return contests;
}

json measure_batch_size(const Settings& settings, const Device& device) {
  const Contestant solver = opencl(device);
  std::vector<Workload> workloads;
  for (const Index segments : {32, 256, 1024, 4096})
    if (!settings.quick || segments <= 256) workloads.push_back(synthetic(segments, 200, 93));
  for (const Workload& workload : workloads)
    difference(solver.backend->solve(workload.data, solver.method), right_answer(workload.data),
               solver, workload.name);

  std::vector<std::vector<double>> costs(workloads.size()), ratios(workloads.size());
  for (int repetition = 0; repetition < std::min(3, settings.repetitions); ++repetition)
    for (std::size_t w = 0; w < workloads.size(); ++w) {
      const SegmentBatch& data = workloads[w].data;
      const double seconds = seconds_of([&] { solver.backend->solve(data, solver.method); });
      costs[w].push_back(seconds / static_cast<double>(data.segments()));
      ratios[w].push_back(costs[w].back() / costs[0].back());
    }
  json record;
  for (std::size_t w = 0; w < workloads.size(); ++w)
    record.push_back({{"segments", workloads[w].data.segments()},
                      {"seconds_per_segment", summary(costs[w])},
                      {"ratio", summary(ratios[w])}});
  return record;
}

json measure_frames(const Settings& settings, const Device& device) {
  const auto contestants = finalists(settings, device);
  json contests;
  for (const Index frames : {25, 50, 93, 100, 200, 400, 1000, 2000})
    contests.push_back(contest(synthetic(16, frames, 93), contestants, settings.repetitions));
  return contests;
}

json measure_columns(const Settings& settings, const Device& device) {
  const auto contestants = finalists(settings, device);
  json contests;
  for (const Index columns : {9, 63, 93, 204, 300})
    contests.push_back(contest(synthetic(16, 400, columns), contestants, settings.repetitions));
  return contests;
}

json measure_products(const Settings& settings, const Device& device) {
  return first_take(settings, product_paths(device));
}

json measure_precision(const Settings& settings, const Device& device) {
  return first_take(settings, precision_modes(device));
}

}  // namespace moclean::bench
