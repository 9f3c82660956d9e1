#pragma once

#include <functional>
#include <span>
#include <vector>

#include "moclean/body/gaps.hpp"
#include "moclean/body/posture_regression.hpp"

namespace moclean {

/// Candidates for the positions of the joint of a gap at some frames, its edges included; always as
/// many. It must not look at the joint within the gap, which may be a trial.
using Predictor = std::function<Candidates(const Gap&, const Frames&)>;

/// How candidates become one fill, and how sure that is: learned from trials, gaps that are hidden
/// where the joint was seen.
struct FillRule {
  struct Share {
    double weight;  ///< of the candidate in the fill; they sum to 1
    double reach;   ///< over which its miss of an edge dies away, share of the gap's length
  };
  std::vector<Share> shares;
  std::vector<double> depths;     ///< places in a gap, ascending: 0 at an edge
  std::vector<double> variances;  ///< of a coordinate, there; never falling
  double usual_miss = 0;          ///< mean square miss of an edge, of a coordinate
  double usual_unlikeness = 0;    ///< Candidates::unlikeness in the trials; 0: not known

  bool empty() const { return shares.empty(); }
};

/// What trials say of the candidates: each has its misses at the edges taken out over the best of
/// a few reaches; the weights are those of the least mean square of the trials' errors, none below
/// 0. Empty without trials.
FillRule learn_fill_rule(const BodyTake& take, std::span<const Gap> trials, Index probed,
                         const Predictor& predict);

/// A fill, [frames x 4]: position, variance of a coordinate. A gap whose edges are missed by more
/// than is usual is less sure, and so is a posture that is more unlike the others.
Matrix fill(const BodyTake& take, const Gap& gap, const Predictor& predict, const FillRule& rule);

}  // namespace moclean
