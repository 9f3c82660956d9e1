#include "moclean/run/batch_rules.hpp"

#include <algorithm>

namespace moclean {
namespace {

// Copies of a take's samples, at most: read 1, stacked 1, solved 2, unstacked 2 and their padding;
// with --verify two more while the reference works, and one of a truth. Written they are 2; a
// report has the noisy take and the truth besides, and the text of the page four times. A chain of
// several steps keeps what it began with. Segments that overlap are stacked and solved at twice
// their length at most, as are those of the reference. A mask and sigma are one more each. Batches
// of automatic segments are four times the takes, data and two results; there are medians, too.
constexpr std::uint64_t copies_solving = 7, copies_verifying = 9, copies_of_truth = 1,
                        copies_chained = 2, copies_overlapping = 4, copies_of_side = 1,
                        copies_choosing = 14, copies_writing = 2, copies_reporting = 8;

bool overlaps(const Step& step) {
  if (std::holds_alternative<Automatic>(step)) return true;
  const auto* low_rank = std::get_if<LowRank>(&step);
  return low_rank && low_rank->segmentation.overlap > 0;
}

bool is_automatic(const Step& step) {
  const auto* low_rank = std::get_if<LowRank>(&step);
  return low_rank && low_rank->segmentation.automatic;
}

std::uint64_t copies_of_sides(const OutputPlan& outputs) {
  return copies_of_side * (!outputs.masks.empty() + !outputs.sigmas.empty());
}

std::uint64_t copies_until_solved(const Job& job) {
  std::uint64_t copies = job.verify ? copies_verifying : copies_solving;
  if (!job.truths.empty() || !job.outputs.reports.empty()) copies += copies_of_truth;
  copies += copies_of_sides(job.outputs);
  if (std::ranges::any_of(job.chain, is_automatic)) copies += copies_choosing;
  if (std::ranges::any_of(job.chain, overlaps)) copies += copies_overlapping;
  if (job.chain.size() > 1) copies += copies_chained;
  return copies;
}

InputNeeds needs_of(const Job& job) {
  InputNeeds needs{.every_sample = !accepts_missing(job.chain),
                   .frame_rate_for = needs_frame_rate(job.chain)};
  if (needs.frame_rate_for.empty() && job.max_gap) needs.frame_rate_for = "--max-gap";
  return needs;
}

}  // namespace

BatchRules rules_of(const Job& job, const BackendTraits& backend) {
  const LowRank* method = first_low_rank(job.chain);
  return {.segmentation = method ? method->segmentation : Segmentation{.whole = true},
          .backend = backend,
          .copies_solving = copies_until_solved(job),
          .copies_writing = (job.outputs.reports.empty() ? copies_writing : copies_reporting) +
                            copies_of_sides(job.outputs),
          .needs = needs_of(job)};
}

}  // namespace moclean
