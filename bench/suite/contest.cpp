#include "suite/contest.hpp"

#include "suite/answer.hpp"
#include "suite/statistics.hpp"

namespace moclean::bench {
namespace {

nlohmann::json description(const Workload& workload, const Solution& right) {
  std::vector<int> iterations, ranks;
  for (const SegmentOutcome& outcome : right.segments) {
    iterations.push_back(outcome.iterations);
    ranks.push_back(outcome.rank.value_or(0));
  }
  std::sort(iterations.begin(), iterations.end());
  std::sort(ranks.begin(), ranks.end());
  return {{"workload", workload.name},
          {"segments", workload.data.segments()},
          {"frames", workload.data.rows()},
          {"columns", workload.data.columns()},
          {"iterations", iterations[iterations.size() / 2]},
          {"rank", ranks[ranks.size() / 2]}};
}

}  // namespace

nlohmann::json contest(const Workload& workload, std::span<const Contestant> contestants,
                       int repetitions) {
  const SegmentBatch& data = workload.data;
  const Solution right = right_answer(data);
  std::vector<double> differences;
  for (const Contestant& contestant : contestants)
    differences.push_back(difference(contestant.backend->solve(data, contestant.method), right,
                                     contestant, workload.name));

  std::vector<std::vector<double>> seconds(contestants.size()), ratios(contestants.size());
  for (int repetition = 0; repetition < repetitions; ++repetition)
    for (std::size_t c = 0; c < contestants.size(); ++c) {
      seconds[c].push_back(
          seconds_of([&] { contestants[c].backend->solve(data, contestants[c].method); }));
      ratios[c].push_back(seconds[c].back() / seconds[0].back());
    }

  nlohmann::json record = description(workload, right);
  const auto frames = static_cast<double>(data.rows());
  for (std::size_t c = 0; c < contestants.size(); ++c)
    record["contestants"].push_back({{"name", contestants[c].name},
                                     {"solver", contestants[c].backend->name()},
                                     {"seconds", summary(seconds[c])},
                                     {"ratio", summary(ratios[c])},
                                     {"frames_per_second", frames / median(seconds[c])},
                                     {"difference", differences[c]}});
  return record;
}

}  // namespace moclean::bench
