#include <optional>

#include "moclean/experiment/grid_config.hpp"

#include "fuzz/memory_use.hpp"
#include "fuzz/target.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

void grid(std::string_view input) {
  const std::filesystem::path file = as_file(input);
  std::optional<GridConfig> config;
  const MemoryUse memory;
  succeeds([&] { config = read_grid(file); });
  memory.expect_within({}, input.size());
  if (!config) return;
  if (config->takes.empty() || config->methods.empty() || config->seeds.empty())
    throw Violation("a grid has takes, methods and seeds");
  for (const GridTake& take : config->takes) {
    expect_showable(take.label);
    if (take.thin < 1 || !(take.rate >= 0)) throw Violation("a take is thinned, has a rate");
  }
}

}  // namespace moclean::fuzz
