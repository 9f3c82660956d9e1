#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "moclean/denoise/chain.hpp"
#include "moclean/motion/recording.hpp"
#include "moclean/noise/noise.hpp"

namespace moclean {

/// A recording without noise that methods are compared on.
struct ExperimentTake {
  std::string name;                   ///< of the file, without folder and extension
  std::string label;                  ///< in tables; no two takes of an experiment share one
  std::filesystem::path file;         ///< where it is from
  Recording clip;                     ///< the truth, every sample of it
  std::vector<int> parents = {};      ///< see joint_parents(); empty: no bone lengths are measured
  std::vector<std::string> excluded;  ///< joints whose names hold one of these (any case) are
                                      ///< spoilt and cleaned, but not measured
};

/// Noises one after the other under one name.
struct ExperimentNoise {
  std::string label;
  NoiseChain noise;
};

/// A way to clean. An empty chain leaves the take as it is: the noise's own figures.
struct ExperimentMethod {
  std::string label;
  Chain chain;
};

/// The axes of an experiment.
struct Experiment {
  std::vector<ExperimentTake> takes;
  std::vector<ExperimentNoise> noises;
  std::vector<ExperimentMethod> methods;
  std::vector<std::uint64_t> seeds;
};

/// One point of it: indices into the axes, and the seed that the noise gets.
struct Cell {
  std::size_t take = 0;
  std::size_t noise = 0;
  std::size_t method = 0;
  std::size_t seed = 0;          ///< index into Experiment::seeds
  std::uint64_t noise_seed = 0;  ///< what corrupt() gets
};

/// What came out of a cell.
struct CellResult {
  /// By name: those of figures() (moclean/metric/figures.hpp) that can be had, `missing`, the share
  /// of the samples that the method has left out, and `seconds`. NaN: nothing to measure. Empty
  /// where `refused` is not.
  std::map<std::string, double, std::less<>> figures = {};
  std::string refused = {};  ///< why the method cannot clean this; empty: it can
  Index frames = 0;
  Index unconverged = 0;  ///< segments that reached max-iterations

  bool operator==(const CellResult&) const = default;

  /// NaN where there is no such figure.
  double figure(std::string_view name) const;
};

/// Seed of the noise of one take: takes get unlike noises, whatever else an experiment holds.
/// Below 2^32.
std::uint64_t noise_seed(std::string_view take_name, std::uint64_t seed);

/// Every combination, each noise seeded by noise_seed(): takes slowest, then noises, methods,
/// seeds.
std::vector<Cell> all_cells(const Experiment& experiment);

/// The shape of a take and a hash of 64 bits of its samples, names, skeleton, rate and exclusions.
std::string take_identity(const ExperimentTake& take);

/// Everything the figures of a cell depend on, as text: the take (its take_identity()), the noise,
/// its seed, the method with all its parameters, and `computed_by`, which names the program and the
/// device.
std::string cell_key(const Experiment& experiment, const Cell& cell, std::string_view take_identity,
                     std::string_view computed_by);

}  // namespace moclean
