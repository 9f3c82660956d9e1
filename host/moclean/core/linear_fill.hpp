#pragma once

#include <span>

#include <Eigen/Core>

namespace moclean {

/// Which samples of a channel were observed: a column of a Mask.
using ObservedChannel =
    Eigen::Ref<const Eigen::Array<bool, Eigen::Dynamic, 1>, 0, Eigen::InnerStride<>>;

/// Puts the line between the nearest observed samples in the place of those that were not, the
/// nearest sample at the ends, and 0 everywhere if none was observed.
void fill_linearly(std::span<double> channel, const ObservedChannel& observed);

}  // namespace moclean
