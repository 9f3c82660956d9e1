#include "moclean/motion/unit.hpp"

#include <array>
#include <utility>

namespace moclean {

std::optional<double> millimetres(std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, double>, 4> known = {
      {{"mm", 1}, {"cm", 10}, {"m", 1000}, {"ASF units", 25.4 / 0.45}}};
  for (const auto& [name, length] : known)
    if (unit == name) return length;
  return std::nullopt;
}

}  // namespace moclean
