#include "moclean/formats/amc.hpp"

#include "moclean/formats/skeleton_positions.hpp"

#include "formats/tiny_files.hpp"
#include "fuzz/recordings.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {
namespace {

Recording read_over_tiny_skeleton(std::string_view content, const std::filesystem::path& file,
                                  const ReadOptions&) {
  static const AcclaimSkeleton skeleton = parse_asf(test::tiny_asf, "tiny.asf");
  return skeleton_positions(parse_amc(content, file, skeleton), file, content.size());
}

}  // namespace

void amc(std::string_view input) {
  read_and_write({.format = amc_format, .read = read_over_tiny_skeleton}, input);
}

}  // namespace moclean::fuzz
