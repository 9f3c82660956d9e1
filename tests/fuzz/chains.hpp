#pragma once

#include <optional>
#include <string>

#include "fuzz/memory_use.hpp"
#include "fuzz/target.hpp"

namespace moclean::fuzz {

/// What `parse` makes of a text, a list of steps with a to_string(): nothing if it refuses the
/// text. Throws Violation for a list without a step, memory out of proportion, or a text of it that
/// cannot be shown.
template <class Parse>
auto parsed_chain(std::string_view input, const Parse& parse) {
  std::optional<decltype(parse(input))> chain;
  const MemoryUse memory;
  succeeds([&] { chain = parse(input); });
  memory.expect_within({}, input.size());
  if (!chain) return chain;
  if (chain->empty()) throw Violation("a chain has a step");
  expect_showable(to_string(*chain));
  return chain;
}

}  // namespace moclean::fuzz
