#pragma once

#include <map>
#include <string>

#include <fmt/format.h>

namespace moclean::test {

/// What became of the faults of each function.
class FaultTable {
 public:
  struct Row {
    long calls = 0;     ///< of an undisturbed run, all works together
    long injected = 0;  ///< runs with a fault
    long told = 0;      ///< ended with an error
    long harmless = 0;  ///< ended with the bits of an undisturbed one
  };

  Row& operator[](const std::string& function) { return rows_[function]; }

  void print(const char* title) const {
    Row sum;
    fmt::print("{}\n{:<28}{:>8}{:>10}{:>8}{:>10}\n", title, "function", "calls", "injected", "told",
               "harmless");
    for (const auto& [function, row] : rows_) {
      fmt::print("{:<28}{:>8}{:>10}{:>8}{:>10}\n", function, row.calls, row.injected, row.told,
                 row.harmless);
      if (function != "any") sum.calls += row.calls;
      sum.injected += row.injected;
      sum.told += row.told;
      sum.harmless += row.harmless;
    }
    fmt::print("{:<28}{:>8}{:>10}{:>8}{:>10}\n", "all", sum.calls, sum.injected, sum.told,
               sum.harmless);
  }

 private:
  std::map<std::string, Row> rows_;
};

}  // namespace moclean::test
