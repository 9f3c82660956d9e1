#include "moclean/linalg/precision.hpp"

#include "moclean/core/error.hpp"

namespace moclean {

std::string to_string(Precision precision) { return precision == Precision::f64 ? "f64" : "mixed"; }

Precision parse_precision(const std::string& text) {
  if (text == "f64") return Precision::f64;
  if (text == "mixed") return Precision::mixed;
  throw ArgumentError("precision is f64 or mixed, not '" + text + "'");
}

}  // namespace moclean
