#pragma once

#include <span>
#include <string_view>

namespace moclean {

/// Changes nothing: what comes out is what a format makes of what came in.
struct NoFilter {
  bool operator==(const NoFilter&) const = default;

  static constexpr std::string_view name = "none";
  static void visit(auto&, auto&) {}
};

inline void check(const NoFilter&) {}
inline void smooth(const NoFilter&, double, std::span<double>) {}

}  // namespace moclean
