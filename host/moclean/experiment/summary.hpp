#pragma once

#include <span>
#include <string>
#include <vector>

#include "moclean/experiment/experiment.hpp"

namespace moclean {

/// Mean and standard deviation (of a sample, n - 1; 0 of one value) of the values that are not NaN.
struct Spread {
  double mean = 0;  ///< NaN of none
  double sd = 0;    ///< NaN of none
  Index count = 0;

  bool operator==(const Spread&) const = default;
};

Spread spread(std::span<const double> values);

/// A figure over the cells for which `chosen(cell)` is true.
template <class Chosen>
Spread spread_of(std::span<const Cell> cells, std::span<const CellResult> results,
                 std::string_view figure, const Chosen& chosen) {
  std::vector<double> values;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (chosen(cells[i])) values.push_back(results[i].figure(figure));
  return spread(values);
}

/// How a method does among the others.
struct Standing {
  std::size_t method = 0;
  /// Mean over takes and noises of its place among the methods by FD (mean over seeds), from 1;
  /// equals share their places. A method that refuses a take or leaves samples missing comes last
  /// there.
  double mean_rank = 0;
  Index wins = 0;                ///< how often it is first
  Index incomplete = 0;          ///< cells refused or with missing samples
  std::vector<Spread> fd;        ///< per noise, over takes and seeds
  double frames_per_second = 0;  ///< of all its cells; infinite where no time was taken
};

/// The methods, best mean rank first. Cells have to be all_cells() of the experiment.
std::vector<Standing> ranking(const Experiment& experiment, std::span<const Cell> cells,
                              std::span<const CellResult> results);

/// A table of all cells, one line each with a head: take, noise, method (labels), seed, noise_seed,
/// frames, every figure there is but those that came later, `refused`, and those (strikes, worst).
/// Numbers are written so that they read back to the same bits; fields are quoted where needed (RFC
/// 4180); NaN and absent figures are empty.
std::string cells_csv(const Experiment& experiment, std::span<const Cell> cells,
                      std::span<const CellResult> results);

}  // namespace moclean
