#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "moclean/core/segment_batch.hpp"

namespace moclean::bench {

/// What is solved: a batch, and its name in the record.
struct Workload {
  std::string name;
  SegmentBatch data;
};

/// A recording spoiled with the noise of Peng et al.: 900 of 2800 frames, Gaussian(1, 1.2).
struct NoisyTake {
  std::string name;
  Matrix samples;
};

/// CMU 14_06 if `data` (a collection with cmu/14/14_06.amc) has it, then the three takes of
/// Debian's package assimp-testmodels as far as they are there. Throws FileError if there is none
/// at all.
std::vector<NoisyTake> noisy_takes(const std::filesystem::path& data);

/// The take in equal segments of about `length` frames; 0: in one.
Workload cut_into_segments(const NoisyTake& take, Index length);

}  // namespace moclean::bench
