#pragma once

#include <functional>
#include <span>
#include <vector>

#include "moclean/body/gaps.hpp"

namespace moclean {

/// Positions [frames x 3] by each of several candidates.
using Candidates = std::vector<Matrix>;

/// Candidates for the positions of the joint of a gap at some frames, its edges included; always as
/// many. It must not look at the joint within the gap, which may be a trial.
using Predictor = std::function<Candidates(const Gap&, const Frames&)>;

/// How candidates become one fill, and how sure that is: learned from trials, gaps that are hidden
/// where the joint was seen. Its variance is a share of how far the candidates disagree in a frame:
/// the mean square of a coordinate of the median candidate's distance from the fill; of a single
/// candidate 1, less near an edge. Added is by how much the edges are missed more than in any
/// trial: one of them may be wrong.
struct FillRule {
  struct Share {
    double weight;  ///< of the candidate in the fill; they sum to 1
    double decay;   ///< over which its miss of an edge dies away, share of the gap's length
  };
  std::vector<Share> shares;
  double least_disagreement = 0;  ///< added to it: candidates may agree by chance
  double variance_share = 0;      ///< of the disagreement
  double most_missed = 0;         ///< mean square miss of the edges, of a coordinate, in a trial

  bool empty() const { return shares.empty(); }
};

/// What trials say of the candidates: each has its misses at the edges taken out over the best of
/// a few decays; the weights are those of the least mean square of the trials' errors, none below
/// 0. Empty without trials.
FillRule learn_fill_rule(const BodyTake& take, std::span<const Gap> trials, Index probed,
                         const Predictor& predict);

/// A fill, [frames x 4]: position, variance of a coordinate.
Matrix fill(const BodyTake& take, const Gap& gap, const Predictor& predict, const FillRule& rule);

}  // namespace moclean
