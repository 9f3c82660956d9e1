#include "moclean/formats/csv.hpp"

#include "fuzz/recordings.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

void csv(std::string_view input) {
  read_and_write({.format = csv_format, .read = csv_format.read, .guesses_columns = true}, input);
}

}  // namespace moclean::fuzz
