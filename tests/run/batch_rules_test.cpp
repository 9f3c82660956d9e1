#include "moclean/run/batch_rules.hpp"

#include <gtest/gtest.h>

namespace moclean {
namespace {

std::uint64_t copies_solving(const char* chain, Job job = {}) {
  job.chain = parse_chain(chain);
  return rules_of(job, {}).copies_solving;
}

TEST(BatchRules, CountTheCopiesOfAllThatHoldsThem) {
  EXPECT_EQ(copies_solving("slra"), 1u + 6u);
  EXPECT_EQ(copies_solving("auto"), 1u + 6u + 4u);
  EXPECT_EQ(copies_solving("slra:segment=auto"), 1u + 6u + 14u);
  EXPECT_EQ(copies_solving("slra+median"), 1u + 6u + 2u);
  EXPECT_EQ(copies_solving("median"), 1u + 6u);
}

TEST(BatchRules, CountWhatAJobAsksFor) {
  EXPECT_EQ(copies_solving("slra", {.verify = true}), 9u);
  EXPECT_EQ(copies_solving("slra", {.truths = {"truth.npy"}}), 8u);
  EXPECT_EQ(copies_solving("slra", {.outputs = {.masks = {"mask.npy"}, .sigmas = {"s.npy"}}}), 9u);
}

TEST(BatchRules, AfterSolvingFewerCopiesAreLeft) {
  const Job plain, page{.outputs = {.reports = {"page.html"}}};

  EXPECT_EQ(rules_of(plain, {}).copies_writing, 2u);
  EXPECT_EQ(rules_of(page, {}).copies_writing, 10u);
}

}  // namespace
}  // namespace moclean
