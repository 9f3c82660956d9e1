// What the machine can do at most: the denominators of every "share of peak".
#include <thread>

#include "peers/rates.hpp"
#include "suite/sections.hpp"
#include "suite/statistics.hpp"

namespace moclean::bench {
namespace {

/// Largest rate of `repetitions` runs on so many threads at once; `work(thread)` returns how much
/// it did.
template <class Work>
double rate(int threads, int repetitions, const Work& work) {
  double best = 0;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    std::vector<double> done(static_cast<std::size_t>(threads));
    const double seconds = seconds_of([&] {
      std::vector<std::jthread> workers;
      for (std::size_t t = 0; t < done.size(); ++t)
        workers.emplace_back([&, t] { done[t] = work(t); });
    });
    double total = 0;
    for (const double amount : done) total += amount;
    best = std::max(best, total / seconds);
  }
  return best;
}

}  // namespace

nlohmann::json measure_limits(const Settings& settings, const Device&) {
  constexpr std::size_t rounds = 20'000'000;
  constexpr std::size_t l2_doubles = 1 << 15, memory_doubles = 1 << 23;  // 256 KiB, 64 MiB
  constexpr int l2_passes = 4000;
  const auto threads = static_cast<std::size_t>(settings.threads);
  std::vector<std::vector<double>> from(threads, std::vector<double>(memory_doubles, 1.0));
  auto to = from;
  const auto measured = [&](const auto& work) { return rate(settings.threads, 5, work) * 1e-9; };
  return {
      {"threads", settings.threads},
      {"double_gflops", measured([](std::size_t) { return peers::multiply_add_double(rounds); })},
      {"float_gflops", measured([](std::size_t) { return peers::multiply_add_float(rounds); })},
      {"l2_copy_gbytes", measured([&](std::size_t t) {
         double bytes = 0;
         for (int pass = 0; pass < l2_passes; ++pass)
           bytes += peers::copy(from[t].data(), to[t].data(), l2_doubles);
         return bytes;
       })},
      {"memory_copy_gbytes", measured([&](std::size_t t) {
         return peers::copy(from[t].data(), to[t].data(), memory_doubles);
       })}};
}

}  // namespace moclean::bench
