#include "moclean/experiment/experiment.hpp"

#include <bit>
#include <limits>

#include <fmt/format.h>

namespace moclean {
namespace {

// FNV-1a (Fowler, Noll, Vo) of 64 bits: tells versions of a file apart, no protection.
class Hash {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) add_byte(static_cast<unsigned char>(byte));
    add_byte(0xff);  // of no text: "a", "bc" is not "ab", "c"
  }
  void add(std::uint64_t word) {
    for (int i = 0; i < 8; ++i) add_byte(static_cast<unsigned char>(word >> (8 * i)));
  }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  std::uint64_t value() const { return value_; }

 private:
  void add_byte(unsigned char byte) { value_ = (value_ ^ byte) * 0x100000001b3U; }

  std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace

double CellResult::figure(std::string_view name) const {
  const auto found = figures.find(name);
  return found == figures.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

std::uint64_t noise_seed(std::string_view take_name, std::uint64_t seed) {
  Hash hash;
  hash.add(take_name);
  hash.add(seed);
  return (hash.value() ^ hash.value() >> 32) & 0xffffffffU;
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
  Hash hash;
  hash.add(static_cast<std::uint64_t>(take.clip.frames()));
  for (const std::string& column : take.clip.columns) hash.add(column);
  for (Index i = 0; i < take.clip.samples.size(); ++i) hash.add(take.clip.samples.data()[i]);
  for (const int parent : take.parents) hash.add(static_cast<std::uint64_t>(parent));
  for (const std::string& fragment : take.excluded) hash.add(fragment);
  hash.add(take.clip.frame_rate);
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
