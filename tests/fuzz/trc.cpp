#include "moclean/formats/trc.hpp"

#include "fuzz/recordings.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

void trc(std::string_view input) {
  read_and_write({.format = trc_format,
                  .read = trc_format.read,
                  .rounds_changes = true,
                  .cuts_while_reading = true},
                 input);
}

}  // namespace moclean::fuzz
