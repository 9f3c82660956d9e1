#pragma once

#include <string>

namespace moclean {

/// What a solver computes with.
enum class Precision {
  f64,   ///< double throughout
  mixed  ///< float matrices of frames, double Gram matrices and eigenproblems: tolerance >= 1e-6
};

std::string to_string(Precision precision);

/// Reads `f64` or `mixed`; throws ArgumentError for anything else.
Precision parse_precision(const std::string& text);

}  // namespace moclean
