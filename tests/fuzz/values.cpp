#include "moclean/experiment/grid_config.hpp"
#include "moclean/run/byte_size.hpp"

#include "cli/options/input_options.hpp"
#include "fuzz/memory_use.hpp"
#include "fuzz/target.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

// What --memory-limit, --frames and `frames` of a grid take.
void values(std::string_view input) {
  const MemoryUse memory;
  succeeds([&] {
    const std::uint64_t bytes = parse_byte_size("--memory-limit", std::string(input));
    if (bytes == 0) throw Violation("a size is above 0");
    expect_showable(byte_text(bytes));
  });
  succeeds([&] {
    const FrameRange range = cli::parse_frame_range(std::string(input));
    if (range.first.value_or(0) < 0 || (range.last && *range.last <= range.first.value_or(0)))
      throw Violation("a range has a frame");
  });
  succeeds([&] {
    const auto span = parse_frame_span(input);
    if (span && span->last && *span->last <= span->first.value_or(0))
      throw Violation("a span has a frame");
  });
  memory.expect_within({}, input.size());
}

}  // namespace moclean::fuzz
