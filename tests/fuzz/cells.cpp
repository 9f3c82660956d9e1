#include "moclean/experiment/results.hpp"

#include "fuzz/memory_use.hpp"
#include "fuzz/target.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

// As an experiment goes on that was killed: reads what is there and adds a cell.
void cells(std::string_view input) {
  const std::filesystem::path file = as_file(input);
  CellResult result{.frames = 7, .unconverged = 1};
  result.figures["fd"] = 0.1;
  result.refused = "why";
  const MemoryUse memory;
  const bool is_read = succeeds([&] { CellResults(file).keep("own", result); });
  memory.expect_within({}, input.size());
  if (!is_read) return;

  const CellResults again(file);
  const CellResult* const found = again.find("own");
  if (!found || *found != result) throw Violation("a cell comes back");
}

}  // namespace moclean::fuzz
