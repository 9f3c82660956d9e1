#include "moclean/run/batch_rules.hpp"

#include "moclean/report/report.hpp"

namespace moclean {
namespace {

constexpr std::uint64_t copy_of_take = 1, copy_of_truth = 1;
constexpr std::uint64_t copies_in_page = 2;  // status and sigma

// A mask and sigma.
std::uint64_t copies_of_sides(const OutputPlan& outputs) {
  return !outputs.masks.empty() + !outputs.sigmas.empty();
}

// While the reference works, the results of the device wait.
std::uint64_t copies_until_solved(const Job& job) {
  std::uint64_t copies = copy_of_take + copies_held(job.chain) + copies_of_sides(job.outputs);
  if (job.verify) copies += copies_in_result;
  if (!job.truths.empty() || !job.outputs.reports.empty()) copies += copy_of_truth;
  return copies;
}

std::uint64_t copies_until_written(const Job& job) {
  std::uint64_t copies = copies_in_result + copies_of_sides(job.outputs);
  if (!job.outputs.reports.empty())
    copies += copies_in_page + copy_of_take + copy_of_truth + copies_in_text;
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
          .copies_writing = copies_until_written(job),
          .needs = needs_of(job)};
}

}  // namespace moclean
