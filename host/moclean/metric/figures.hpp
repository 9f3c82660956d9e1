#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "moclean/motion/recording.hpp"

namespace moclean {

/// What an estimate is measured with. Everything but the two clips may be left out.
struct Evaluation {
  const Recording& truth;
  const Recording& estimate;
  const Mask* touched = nullptr;      ///< what noise had touched
  const Matrix* outliers = nullptr;   ///< what the method took away
  std::span<const int> parents = {};  ///< of the joints, see bone_length_error()
  double outlier_threshold = 0;       ///< see detection()
};

/// One figure of merit.
struct Figure {
  std::string_view name;         ///< snake_case: the key in records
  std::string_view description;  ///< a few words
  std::string_view unit;         ///< "length", "length/frame^2" or "" for a share
  bool larger_is_better = false;
  /// Nothing where the evaluation lacks what the figure needs. Throws as the metric does.
  std::optional<double> (*of)(const Evaluation&);
};

/// Every figure there is, in the order they are reported.
std::span<const Figure> figures();

}  // namespace moclean
