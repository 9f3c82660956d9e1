#pragma once

#include "moclean/experiment/experiment.hpp"

#include "support/synthetic_walk.hpp"

namespace moclean::test {

/// A take of the first ten joints of a synthetic walk.
inline ExperimentTake small_take(const std::string& name, Index frames, std::uint64_t seed = 1) {
  Recording walk = synthetic_walk(frames, seed);
  walk.samples.conservativeResize(frames, 30);
  walk.columns.resize(30);
  return {.name = name, .label = name, .file = name + ".npy", .clip = walk, .excluded = {}};
}

/// Two takes, two noises (one with gaps), four methods, two seeds.
inline Experiment small_experiment() {
  Experiment experiment{
      .takes = {small_take("a", 60), small_take("b", 45, 2)},
      .noises = {{"frames", parse_noise_chain("gaussian-frames:fraction=0.3")},
                 {"gaps", parse_noise_chain("gap:count=2,length=10+gaussian:sd=0.1")}},
      .methods = {{"none", {}}},
      .seeds = {1, 4}};
  for (const char* text : {"median:window=3", "slra:segments=2", "tsvd:rank=5"})
    experiment.methods.push_back({text, parse_chain(text)});
  return experiment;
}

}  // namespace moclean::test
