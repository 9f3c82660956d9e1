#include "moclean/denoise/chain.hpp"

#include "fuzz/chains.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

void method(std::string_view input) {
  const auto chain = parsed_chain(input, [](auto text) { return parse_chain(text); });
  if (!chain) return;
  const std::string text = to_string(*chain);
  if (parse_chain(text) != *chain) throw Violation("a chain is read back from " + text);
}

}  // namespace moclean::fuzz
