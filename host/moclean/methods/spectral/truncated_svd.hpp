#pragma once

#include <string_view>

#include "moclean/core/parameters.hpp"

namespace moclean {

/// Truncated singular value decomposition: A is the part of D in its `rank` largest singular
/// values, the nearest matrix of that rank (Eckart, Young 1936); E = D - A. Knows nothing of sparse
/// errors: each spreads over all columns.
struct TruncatedSvd {
  Index rank = 10;  ///< singular values kept, >= 1; all of them if there are fewer

  bool operator==(const TruncatedSvd&) const = default;

  static constexpr std::string_view name = "tsvd";
  static void visit(auto& self, auto& visitor) { visitor("rank", self.rank); }
};

/// Throws ArgumentError naming the first parameter out of its range.
void check(const TruncatedSvd& method);

}  // namespace moclean
