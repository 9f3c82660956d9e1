#include "cli/commands/tuning_contest.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "moclean/backend/opencl_backend.hpp"
#include "moclean/core/error.hpp"
#include "moclean/denoise/agreement.hpp"

namespace moclean::cli {
namespace {

struct Candidate {
  std::string choice;
  Tuning tuning;
};

// The kinds of choices in the order in which they are settled; each gives the alternatives to what
// has been settled before it.
using Kind = std::vector<Candidate> (*)(const Tuning& settled, bool quick);

std::vector<Candidate> eigen_forms(const Tuning& settled, bool quick) {
  if (quick) return {};
  Tuning other = settled;
  other.eigen = settled.eigen == KernelForm::cpu ? KernelForm::gpu : KernelForm::cpu;
  return {{"eigensolver " + to_string(other.eigen), other}};
}

// Every form with every product.
std::vector<Candidate> forms(const Tuning& settled, bool quick) {
  if (quick) return {};
  std::vector<Candidate> all;
  for (const KernelForm form : {KernelForm::cpu, KernelForm::gpu})
    for (const ProductPath products : {ProductPath::own, ProductPath::clblast}) {
      Tuning other = settled;
      other.form = form;
      other.products = products;
      if (other == settled) continue;
      all.push_back(
          {fmt::format("form {}, products {}", to_string(form), to_string(products)), other});
    }
  return all;
}

bool has_tiles(const Tuning& tuning) {
  return tuning.form == KernelForm::cpu && tuning.products == ProductPath::own;
}

std::vector<Candidate> variants(const Tuning& settled, const char* name,
                                const std::vector<int>& values, int Tuning::*member) {
  std::vector<Candidate> all;
  for (const int value : values) {
    if (value == settled.*member) continue;
    Tuning other = settled;
    other.*member = value;
    all.push_back({fmt::format("{} {}", name, value), other});
  }
  return all;
}

std::vector<Candidate> work_groups(const Tuning& settled, bool quick) {
  if (settled.form != KernelForm::gpu || quick) return {};
  return variants(settled, "work-groups of", {64, 128, 256}, &Tuning::work_group);
}

std::vector<Candidate> tiles(const Tuning& settled, bool quick) {
  if (!has_tiles(settled)) return {};
  std::vector<Candidate> all;
  for (const auto& [rows, vectors] : {std::pair(4, 3), {4, 4}, {6, 3}, {6, 4}, {8, 2}, {12, 2}}) {
    Tuning other = settled;
    other.tile_rows = rows;
    other.tile_vectors = vectors;
    all.push_back({fmt::format("tile {} x {}", rows, vectors), other});
  }
  if (quick) all.resize(1);
  return all;
}

std::vector<Candidate> sweeps(const Tuning& settled, bool quick) {
  if (!has_tiles(settled)) return {};
  return variants(settled, "sweep rows", quick ? std::vector{16} : std::vector{16, 24, 48, 64},
                  &Tuning::sweep_rows);
}

std::vector<Candidate> panels(const Tuning& settled, bool quick) {
  if (settled.eigen != KernelForm::cpu || quick) return {};
  return variants(settled, "panel", {2, 3, 6, 8}, &Tuning::panel);
}

std::vector<Candidate> batches(const Tuning& settled, bool quick) {
  std::vector<Candidate> all;
  for (const std::int64_t segments : {8, 16, 32}) {
    Tuning other = settled;
    other.batch_segments = segments;
    all.push_back({fmt::format("batch {}", segments), other});
  }
  if (quick) all.resize(1);
  return all;
}

std::vector<Candidate> queues(const Tuning& settled, bool quick) {
  std::vector<Candidate> all = variants(settled, "queues", {1, 2, 3, 4}, &Tuning::queues);
  if (quick) all.resize(1);
  return all;
}

constexpr Kind kinds[] = {eigen_forms, forms, work_groups, tiles, sweeps, panels, queues, batches};

bool equal_bits(const SegmentBatch& a, const SegmentBatch& b) {
  return std::ranges::equal(a.storage(), b.storage());
}

double relative_difference(const SegmentBatch& tested, const SegmentBatch& expected) {
  double difference = 0, norm = 0;
  for (Index b = 0; b < expected.segments(); ++b) {
    difference += (tested.segment(b) - expected.segment(b)).squaredNorm();
    norm += expected.segment(b).squaredNorm();
  }
  return difference == 0 ? 0 : std::sqrt(difference / norm);
}

bool is_close(const Solution& tested, const Solution& expected) {
  Agreement found{.low_rank = relative_difference(tested.low_rank, expected.low_rank),
                  .sparse = relative_difference(tested.sparse, expected.sparse)};
  for (std::size_t b = 0; b < expected.segments.size(); ++b) {
    const SegmentOutcome &own = tested.segments[b], &other = expected.segments[b];
    found.iterations_apart =
        std::max(found.iterations_apart, std::abs(own.iterations - other.iterations));
    found.ranks_apart =
        std::max(found.ranks_apart, std::abs(own.rank.value_or(0) - other.rank.value_or(0)));
  }
  return within(found);
}

class Contest {
 public:
  Contest(const Device& device, const SegmentBatch& data, const ContestRules& rules,
          const std::stop_token& stop)
      : device_(device), data_(data), rules_(rules), stop_(stop) {}

  // The default alone: its answer is what the others are compared with.
  TriedTuning run_default(const Tuning& tuning) {
    Contestant contestant = enter({"default", tuning});
    expected_ = std::move(contestant.answer);
    for (int i = 0; i < rules_.repetitions; ++i) measure(contestant);
    return settle(contestant, contestant);
  }

  // The settled choice first, then its rivals.
  std::vector<TriedTuning> run(const Tuning& settled, const std::vector<Candidate>& rivals) {
    std::vector<Contestant> all;
    all.push_back(enter({"settled", settled}));
    for (const Candidate& rival : rivals) all.push_back(enter(rival));
    for (std::size_t i = 1; i < all.size(); ++i) compare(all[i], all[0]);
    for (int i = 0; i < rules_.repetitions; ++i)
      for (Contestant& contestant : all)
        if (contestant.competes) measure(contestant);
    std::vector<TriedTuning> tried;
    for (std::size_t i = 1; i < all.size(); ++i) tried.push_back(settle(all[i], all[0]));
    return tried;
  }

 private:
  struct Contestant {
    Candidate candidate;
    std::unique_ptr<OpenClBackend> backend;
    std::optional<Solution> answer = {};
    double first_seconds = 0;
    std::vector<double> seconds = {};
    TriedTuning::Result result = TriedTuning::Result::same_bits;
    bool competes = true;
  };

  static double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
  }

  double timed_solve(Contestant& contestant) {
    const auto begin = std::chrono::steady_clock::now();
    contestant.answer = contestant.backend->solve(data_, RobustPca{}, {.stop = stop_});
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    return elapsed.count();
  }

  // The first solve of all reserves memory and is not counted; the second says what to expect.
  Contestant enter(const Candidate& candidate) {
    if (stop_.stop_requested()) throw Cancelled();
    Contestant contestant{candidate, std::make_unique<OpenClBackend>(
                                         device_, OpenClOptions{.tuning = candidate.tuning})};
    timed_solve(contestant);
    contestant.first_seconds = timed_solve(contestant);
    return contestant;
  }

  void measure(Contestant& contestant) { contestant.seconds.push_back(timed_solve(contestant)); }

  void compare(Contestant& contestant, const Contestant& settled) {
    using Result = TriedTuning::Result;
    const Solution &own = *contestant.answer, &expected = *expected_;
    const bool equal =
        equal_bits(own.low_rank, expected.low_rank) && equal_bits(own.sparse, expected.sparse);
    if (equal)
      contestant.result = Result::same_bits;
    else if (!same_bits(contestant.candidate.tuning, default_tuning(device_.info())) &&
             is_close(own, expected))
      contestant.result = Result::close;
    else
      contestant.result = Result::wrong;
    contestant.competes = contestant.result != Result::wrong &&
                          contestant.first_seconds <= rules_.hopeless * settled.first_seconds;
  }

  // Of two solves in the same turn: what slows the machine down slows both.
  static double ratio_of(const Contestant& contestant, const Contestant& settled) {
    if (contestant.seconds.empty()) return contestant.first_seconds / settled.first_seconds;
    std::vector<double> ratios;
    for (std::size_t i = 0; i < contestant.seconds.size(); ++i)
      ratios.push_back(contestant.seconds[i] / settled.seconds[i]);
    return median(std::move(ratios));
  }

  static TriedTuning settle(const Contestant& contestant, const Contestant& settled) {
    const auto& seconds = contestant.seconds;
    return {.choice = contestant.candidate.choice,
            .tuning = contestant.candidate.tuning,
            .seconds = seconds.empty() ? contestant.first_seconds : median(seconds),
            .ratio = ratio_of(contestant, settled),
            .repetitions = static_cast<int>(seconds.size()),
            .result = contestant.result};
  }

  const Device& device_;
  const SegmentBatch& data_;
  const ContestRules& rules_;
  std::stop_token stop_;
  std::optional<Solution> expected_;
};

}  // namespace

std::string to_string(TriedTuning::Result result) {
  switch (result) {
    case TriedTuning::Result::same_bits:
      return "bit-identical";
    case TriedTuning::Result::close:
      return "within tolerance";
    case TriedTuning::Result::wrong:
      break;
  }
  return "differs: not used";
}

ContestReport find_best_tuning(const Device& device, const SegmentBatch& data,
                               const ContestRules& rules,
                               const std::function<void(const TriedTuning&)>& report,
                               const std::stop_token& stop) {
  Contest contest(device, data, rules, stop);
  ContestReport all{.tried = {}, .best = default_tuning(device.info())};
  all.tried.push_back(contest.run_default(all.best));
  report(all.tried.back());
  for (const Kind& kind : kinds) {
    const auto rivals = kind(all.best, rules.quick);
    if (rivals.empty()) continue;
    double least = 1 - rules.least_gain;
    for (const TriedTuning& tried : contest.run(all.best, rivals)) {
      report(tried);
      if (tried.repetitions > 0 && tried.ratio <= least) {
        least = tried.ratio;
        all.best = tried.tuning;
      }
      all.tried.push_back(tried);
    }
  }
  return all;
}

}  // namespace moclean::cli
