#pragma once

#include <vector>

#include "moclean/motion/recording.hpp"

namespace moclean {

/// Makes NaN of the samples that say `marks`: of points, where every coordinate is the mark or, for
/// a mark other than 0, any is; of plain channels, where the sample is. A mark is compared exactly.
void apply_missing_marks(const std::vector<double>& marks, Recording& recording);

/// Adds a warning of a number that recurs like a mark for missing samples: the same one in every
/// coordinate of a point, or in a plain channel one of the usual ones (-9999, -999, 9999, ...), in
/// at least three frames but not in all, and farther from all other samples than these are apart.
/// Changes no sample.
void warn_of_marks(Recording& recording);

}  // namespace moclean
