#include <optional>

#include "moclean/denoise/chain.hpp"

#include "fuzz/memory_use.hpp"
#include "fuzz/target.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

void method(std::string_view input) {
  std::optional<Chain> chain;
  const MemoryUse memory;
  succeeds([&] { chain = parse_chain(input); });
  memory.expect_within({}, input.size());
  if (!chain) return;
  if (chain->empty()) throw Violation("a chain has a step");
  const std::string text = to_string(*chain);
  expect_showable(text);
  if (parse_chain(text) != *chain) throw Violation("a chain is read back from " + text);
}

}  // namespace moclean::fuzz
