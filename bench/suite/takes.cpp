#include "suite/takes.hpp"

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/read_write.hpp"
#include "moclean/noise/noise.hpp"
#include "moclean/segment/plan.hpp"

namespace moclean::bench {
namespace {

const std::filesystem::path debian_takes = "/usr/share/assimp/models/BVH";
constexpr double noisy_share = 900.0 / 2800;

}  // namespace

std::vector<NoisyTake> noisy_takes(const std::filesystem::path& data) {
  std::vector<NoisyTake> takes;
  for (const auto& file : {data / "cmu/14/14_06.amc", debian_takes / "01_01.bvh",
                           debian_takes / "01_03.bvh", debian_takes / "Boxing_Toes.bvh"}) {
    if (!std::filesystem::exists(file)) continue;
    const GaussianFrames noise{.fraction = noisy_share, .mean = 1, .sd = 1.2};
    takes.push_back({file.stem(), corrupt(read_recording(file), noise, 1).clip.samples});
  }
  if (takes.empty())
    throw FileError(debian_takes, "no takes here (Debian package assimp-testmodels)");
  return takes;
}

Workload cut_into_segments(const NoisyTake& take, Index length) {
  const Index frames = take.samples.rows();
  const SegmentPlan plan =
      length == 0 ? equal_segments(frames, 1) : segments_of_length(frames, length);
  SegmentBatch batch(take.samples.cols(), plan);
  batch.block(0, frames) = take.samples;
  const std::string cut = length == 0 ? "whole" : fmt::format("{} frames", length);
  return {fmt::format("{}, {}", take.name, cut), std::move(batch)};
}

}  // namespace moclean::bench
