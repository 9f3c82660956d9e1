#include "moclean/formats/c3d.hpp"

#include "fuzz/recordings.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

void c3d(std::string_view input) {
  read_and_write({.format = c3d_format, .read = c3d_format.read}, input);
}

}  // namespace moclean::fuzz
