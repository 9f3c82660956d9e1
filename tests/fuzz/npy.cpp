#include "moclean/formats/npy.hpp"

#include "fuzz/recordings.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

void npy(std::string_view input) {
  read_and_write({.format = npy_format,
                  .read = npy_format.read,
                  .holds_infinite = true,
                  .guesses_columns = true},
                 input);
}

}  // namespace moclean::fuzz
