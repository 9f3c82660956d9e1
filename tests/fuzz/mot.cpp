#include "moclean/formats/mot.hpp"

#include "fuzz/recordings.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

void mot(std::string_view input) {
  read_and_write({.format = mot_format, .read = mot_format.read, .guesses_columns = true}, input);
}

}  // namespace moclean::fuzz
