#include "moclean/formats/tsv.hpp"

#include "fuzz/recordings.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

void tsv(std::string_view input) {
  read_and_write({.format = tsv_format, .read = tsv_format.read, .guesses_columns = true}, input);
}

}  // namespace moclean::fuzz
