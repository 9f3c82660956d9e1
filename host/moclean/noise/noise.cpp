#include "moclean/noise/noise.hpp"

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/parameters.hpp"
#include "moclean/core/usable.hpp"

namespace moclean {
namespace {

template <class Model>
Model read(const Specification& specification) {
  if constexpr (std::is_same_v<Model, GaussianFrames>)
    return parse_gaussian_frames(specification);
  else
    return read_parameters<Model>(specification);
}

template <class Model>
std::string write(const Model& model) {
  if constexpr (std::is_same_v<Model, GaussianFrames>)
    return to_string(model);
  else
    return to_specification(model);
}

// No method takes what is larger, and squares of it are no numbers.
void require_sensible(const Noise& noise, const Matrix& samples) {
  if (const auto place = first_unusable(samples, true, largest_entry))
    throw ArgumentError(fmt::format("{}: makes {:.3g} of a sample in frame {}, expected at most {}",
                                    to_string(noise), samples(place->frame, place->column),
                                    place->frame, largest_entry));
}

}  // namespace

std::vector<std::string_view> noise_names() { return names_of<Noise>(); }

Noise parse_noise(std::string_view specification) {
  const Specification parsed("noise", specification);
  const auto noise = find_alternative<Noise>(
      parsed,
      []<class Model>(const Specification& given, const Model&) { return read<Model>(given); });
  if (!noise) parsed.throw_unknown(noise_names());
  return *noise;
}

std::string to_string(const Noise& noise) {
  return std::visit([](const auto& model) { return write(model); }, noise);
}

NoiseChain parse_noise_chain(std::string_view specification) {
  NoiseChain chain;
  for (const std::string_view text : split_chain(specification)) chain.push_back(parse_noise(text));
  return chain;
}

std::string to_string(const NoiseChain& chain) {
  std::string text;
  for (const Noise& noise : chain) {
    if (!text.empty()) text += '+';
    text += to_string(noise);
  }
  return text;
}

Corrupted corrupt(const Recording& clip, const Noise& noise, std::uint64_t seed) {
  return corrupt(clip, NoiseChain{noise}, seed);
}

Corrupted corrupt(const Recording& clip, const NoiseChain& chain, std::uint64_t seed) {
  if (chain.empty()) throw ArgumentError("a chain needs at least one noise");
  Corrupted result{clip, Mask::Constant(clip.samples.rows(), clip.samples.cols(), false)};
  Random random(seed);
  for (const Noise& noise : chain) {
    const auto add = [&](const auto& model) { return add_noise(model, random, result.clip); };
    result.touched = result.touched || std::visit(add, noise);
    require_sensible(noise, result.clip.samples);
  }
  return result;
}

}  // namespace moclean
