#pragma once

#include "moclean/report/report.hpp"

namespace moclean::test {

/// A report of a made-up walk of ten joints in one chain, with truth, a gap of joint 4 in frames 20
/// to 29, one segment that did not converge, a table and parameters. Its title is `title`.
Report sample_report(const std::string& title);

/// A take of so many frames and joints, noise in all entries of every third frame, with truth.
ReportTake noisy_take(Index frames, Index joint_count);

}  // namespace moclean::test
