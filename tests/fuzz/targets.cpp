#include "fuzz/targets.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace moclean::fuzz {

Run target_named(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, Run>, 19> all = {{
      {"amc", amc},     {"asf", asf},           {"bvh", bvh},       {"c3d", c3d},
      {"cells", cells}, {"columns", columns},   {"config", config}, {"csv", csv},
      {"grid", grid},   {"manifest", manifest}, {"method", method}, {"mot", mot},
      {"noise", noise}, {"npy", npy},           {"npz", npz},       {"trc", trc},
      {"tsv", tsv},     {"tuning", tuning},     {"values", values},
  }};
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& entry) { return entry.first == name; });
  if (found == all.end()) throw std::out_of_range("no such fuzz target");
  return found->second;
}

}  // namespace moclean::fuzz
