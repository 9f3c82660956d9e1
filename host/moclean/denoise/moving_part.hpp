#pragma once

#include <optional>
#include <vector>

#include "moclean/denoise/denoiser.hpp"

namespace moclean {

/// What of a take the smoother is for: joints and columns that move, about a middle of their own,
/// so that neither a point at rest nor the place of the origin has a say.
struct MovingPart {
  Recording clip;                ///< NaN where missing or lost
  std::vector<Index> columns;    ///< of the take, which those of the clip are
  Eigen::RowVectorXd medians;    ///< [columns of the take], 0 for one without a sample
  Eigen::RowVectorXd centre;     ///< [columns of the take], taken from every sample: see below
  std::vector<bool> still = {};  ///< [columns of the take]: all its samples are the same
  double unit = 1;               ///< of the clip's samples, a power of two: not 1
                    ///< only where squares of lengths would leave the range of a double
};

/// The centre of a column of no joint is its median. Joints have one centre together, so that their
/// distances stay: the median over the joints that move of their columns' medians, x, y and z.
///
/// The moving part of a take. A joint is left out if all three of its columns are still, a column
/// of no joint if it is. With `find_lost`, joints that vanished() are missing; points of a picture
/// (two columns) are looked at by themselves, without a depth.
MovingPart moving_part(const Recording& take, bool find_lost);

/// Makes the result of the moving part one of the take: still columns keep their value in every
/// frame, with deviation 0 where it was observed; a sample that came through unchanged, up to
/// rounding, is the take's to the last bit; outliers are what was observed and not trusted.
void put_back(const Recording& take, const MovingPart& part, Denoised& result);

}  // namespace moclean
