#include "moclean/noise/noise.hpp"

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/noise/specification.hpp"

namespace moclean {

Noise parse_noise(std::string_view specification) {
  const NoiseSpecification parsed(specification);
  if (parsed.name() == "gaussian-frames") return parse_gaussian_frames(parsed);
  throw ArgumentError(fmt::format("unknown noise '{}', expected gaussian-frames", parsed.name()));
}

std::string to_string(const Noise& noise) {
  return std::visit([](const auto& model) { return to_string(model); }, noise);
}

Corrupted corrupt(const Clip& clip, const Noise& noise, std::uint64_t seed) {
  Corrupted result{clip, {}};
  Random random(seed);
  std::visit([&](const auto& model) { add_noise(model, random, result.clip.samples); }, noise);

  const auto clean = clip.samples.array();
  result.touched = !clean.isNaN() && result.clip.samples.array() != clean;
  return result;
}

}  // namespace moclean
