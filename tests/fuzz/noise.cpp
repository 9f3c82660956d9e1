#include "moclean/noise/noise.hpp"

#include "fuzz/chains.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

void noise(std::string_view input) {
  const auto chain = parsed_chain(input, [](auto text) { return parse_noise_chain(text); });
  if (!chain) return;
  const std::string text = to_string(*chain);
  if (to_string(parse_noise_chain(text)) != text)
    throw Violation("noises are read back from " + text);
}

}  // namespace moclean::fuzz
