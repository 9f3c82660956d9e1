#include "moclean/formats/npz.hpp"

#include "fuzz/recordings.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

void npz(std::string_view input) {
  read_and_write({.format = npz_format,
                  .read = npz_format.read,
                  .holds_infinite = true,
                  .guesses_columns = true},
                 input);
}

}  // namespace moclean::fuzz
