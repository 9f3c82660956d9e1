#include "moclean/experiment/experiment.hpp"

#include <limits>

#include <fmt/format.h>

#include "moclean/core/hash.hpp"

namespace moclean {
double CellResult::figure(std::string_view name) const {
  const auto found = figures.find(name);
  return found == figures.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

std::uint64_t noise_seed(std::string_view take_name, std::uint64_t seed) {
  const std::uint64_t hash = Fnv1a().text(take_name).word(seed).value();
  return (hash ^ hash >> 32) & 0xffffffffU;
}

std::vector<Cell> all_cells(const Experiment& experiment) {
  std::vector<Cell> cells;
  for (std::size_t t = 0; t < experiment.takes.size(); ++t)
    for (std::size_t n = 0; n < experiment.noises.size(); ++n)
      for (std::size_t m = 0; m < experiment.methods.size(); ++m)
        for (std::size_t s = 0; s < experiment.seeds.size(); ++s)
          cells.push_back({t, n, m, s, noise_seed(experiment.takes[t].name, experiment.seeds[s])});
  return cells;
}

std::string take_identity(const ExperimentTake& take) {
  Fnv1a hash;
  hash.word(static_cast<std::uint64_t>(take.clip.frames()));
  for (const std::string& column : take.clip.columns) hash.text(column);
  for (Index i = 0; i < take.clip.samples.size(); ++i) hash.number(take.clip.samples.data()[i]);
  for (const int parent : take.parents) hash.word(static_cast<std::uint64_t>(parent));
  for (const std::string& fragment : take.excluded) hash.text(fragment);
  hash.number(take.clip.frame_rate);
  return fmt::format("{}x{}-{:016x}", take.clip.frames(), take.clip.samples.cols(), hash.value());
}

std::string cell_key(const Experiment& experiment, const Cell& cell, std::string_view identity,
                     std::string_view computed_by) {
  const Chain& chain = experiment.methods[cell.method].chain;
  return fmt::format("{} | {} | {} | seed {} | {}", computed_by, identity,
                     to_string(experiment.noises[cell.noise].noise), cell.noise_seed,
                     chain.empty() ? "none" : to_string(chain));
}

}  // namespace moclean
