#include "moclean/formats/bvh.hpp"

#include "fuzz/recordings.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

void bvh(std::string_view input) {
  read_and_write({.format = bvh_format, .read = bvh_format.read}, input);
}

}  // namespace moclean::fuzz
