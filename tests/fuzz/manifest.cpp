#include "cli/batch/manifest.hpp"

#include <optional>

#include "fuzz/memory_use.hpp"
#include "fuzz/target.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

// As `moclean denoise FOLDER -o RESULTS --resume` reads it.
void manifest(std::string_view input) {
  const std::filesystem::path root = as_file_named(cli::manifest_name, input).parent_path();
  const cli::ManifestTake take{.file = "in/take.bvh",
                               .input = "in/take.bvh",
                               .outputs = {root / "take.csv"},
                               .parameters = cli::Json::object()};
  std::vector<std::filesystem::path> results;
  const auto look = [&] {
    cli::Manifest manifest(root);
    if (manifest.is_done(take)) throw Violation("a result that is not there is not done");
    static_cast<void>(manifest.is_result(root / cli::manifest_name));
    results = manifest.results_below("in");
    for (const auto& side : manifest.sides()) results.push_back(side);
    manifest.tidy();
  };
  const MemoryUse memory;
  if (!succeeds(look)) throw Violation("lines that are none of a manifest are left out");
  memory.expect_within({}, input.size());

  const std::vector<std::filesystem::path> before = results;
  if (!succeeds(look) || results != before) throw Violation("tidied lines are the same results");
}

}  // namespace moclean::fuzz
