#include "moclean/formats/npz.hpp"

#include "fuzz/recordings.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

void npz(std::string_view input) {
  read_and_write(
      {.format = npz_format,
       .read = npz_format.read,
       .holds_infinite = true,
       .copies_unread = true,
       .guesses_columns = true,
       // libzip makes room for as many members as the end of an archive states, up to 65535.
       .bound = {.fixed = 12 << 20}},
      input);
}

}  // namespace moclean::fuzz
