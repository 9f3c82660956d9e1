#pragma once

#include <cstddef>

#include "peers/segment_solver.hpp"

namespace moclean::peers {

// What this processor can do at most, measured on the calling thread with its widest vectors.

/// Operations of `rounds` rounds of independent fused multiply-adds, and the work itself.
MOCLEAN_PEER double multiply_add_double(std::size_t rounds);
MOCLEAN_PEER double multiply_add_float(std::size_t rounds);

/// Copies `count` doubles and returns the bytes read and written.
MOCLEAN_PEER double copy(const double* from, double* to, std::size_t count);

}  // namespace moclean::peers
