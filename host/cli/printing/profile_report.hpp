#pragma once

#include <string>
#include <vector>

#include "moclean/device/profile.hpp"
#include "moclean/linalg/peak.hpp"
#include "moclean/linalg/precision.hpp"

#include "cli/printing/json_record.hpp"

namespace moclean::cli {

/// What --profile found.
struct ProfileReport {
  std::vector<KernelProfile> kernels;
  double busy_seconds = 0;  ///< during which at least one kernel ran
  Peak peak;
  double solve_seconds = 0;              ///< wall time of all solving
  Precision precision = Precision::f64;  ///< decides which peak of arithmetic counts
};

/// A table for people: per kernel calls, time, share of the solve time, rates, and the larger of
/// the shares of the two peaks; `-` where the work of a kernel is not known. Time that kernels of
/// several queues share is divided between all in proportion to their sums, so that the shares and
/// that of the rest make 100 %.
std::string profile_table(const ProfileReport& report);

/// The same for --json; rates and share are null where the work is not known.
Json profile_record(const ProfileReport& report);

}  // namespace moclean::cli
