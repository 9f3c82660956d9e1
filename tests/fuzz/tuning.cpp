#include "cli/backend/tuning_cache.hpp"
#include "fuzz/memory_use.hpp"
#include "fuzz/target.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

void tuning(std::string_view input) {
  const std::filesystem::path file = as_file(input);
  DeviceInfo device;
  device.name = "n";
  device.platform_name = "p";
  device.driver = "d";
  cli::CachedTuning cached;
  const MemoryUse memory;
  if (!succeeds([&] { cached = cli::read_tuning(file, device); }))
    throw Violation("a bad cache is a problem to report, no failure");
  memory.expect_within({}, input.size());
  if (cached.tuning.has_value() == !cached.problem.empty())
    throw Violation("a cache holds a tuning or has a problem");
  expect_showable(cached.problem);
  if (!cached.tuning) return;
  const std::filesystem::path copy = as_file_named("tuning.json", "");
  cli::write_tuning(copy, device, *cached.tuning);
  if (cli::read_tuning(copy, device).tuning != cached.tuning)
    throw Violation("a tuning comes back");
}

}  // namespace moclean::fuzz
