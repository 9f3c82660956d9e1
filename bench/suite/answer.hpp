#pragma once

#include <string>

#include "suite/contestant.hpp"

namespace moclean::bench {

/// The default method's solution: by the Eigen reference up to 64 segments; beyond, where that
/// would take minutes, by the textbook LAPACK peer.
Solution right_answer(const SegmentBatch& data);

/// Largest relative difference of A over the segments. Throws Error if it is more than the
/// contestant's `agreement`, or if a number of iterations differs although the contestant was asked
/// for the default method.
double difference(const Solution& solution, const Solution& right, const Contestant& contestant,
                  const std::string& workload);

}  // namespace moclean::bench
