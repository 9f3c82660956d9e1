#include "moclean/noise/noise.hpp"

#include <optional>

#include "fuzz/memory_use.hpp"
#include "fuzz/target.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

void noise(std::string_view input) {
  std::optional<NoiseChain> chain;
  const MemoryUse memory;
  succeeds([&] { chain = parse_noise_chain(input); });
  memory.expect_within({}, input.size());
  if (!chain) return;
  if (chain->empty()) throw Violation("a chain has a noise");
  const std::string text = to_string(*chain);
  expect_showable(text);
  if (to_string(parse_noise_chain(text)) != text)
    throw Violation("noises are read back from " + text);
}

}  // namespace moclean::fuzz
