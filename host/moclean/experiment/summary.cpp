#include "moclean/experiment/summary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

namespace moclean {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool is_incomplete(const CellResult& result) {
  return !result.refused.empty() || result.figure("missing") > 0;
}

// Per method the mean FD over seeds of one take and noise; infinite where a cell is incomplete.
std::vector<double> levels(const Experiment& experiment, std::span<const Cell> cells,
                           std::span<const CellResult> results, std::size_t take,
                           std::size_t noise) {
  std::vector<std::vector<double>> values(experiment.methods.size());
  std::vector<double> means;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].take != take || cells[i].noise != noise) continue;
    values[cells[i].method].push_back(is_incomplete(results[i]) ? infinity
                                                                : results[i].figure("fd"));
  }
  for (const std::vector<double>& own : values) {
    const bool all = std::ranges::all_of(own, [](double x) { return std::isfinite(x); });
    means.push_back(all ? spread(own).mean : infinity);
  }
  return means;
}

// Place of each among all, from 1; equals share the mean of their places.
std::vector<double> places(const std::vector<double>& levels) {
  std::vector<double> result;
  for (const double own : levels) {
    const auto before = std::ranges::count_if(levels, [&](double x) { return x < own; });
    const auto equal = std::ranges::count(levels, own);
    result.push_back(static_cast<double>(before) + (static_cast<double>(equal) + 1) / 2);
  }
  return result;
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string result = "\"";
  for (const char letter : text)
    result += letter == '"' ? std::string("\"\"") : std::string{letter};
  return result + '"';
}

// A number as a further field of a line; NaN is empty.
std::string field(double value) { return std::isnan(value) ? "," : fmt::format(",{}", value); }

// Counts, incomplete cells, FD and speed of one method; the ranks are not known yet.
Standing standing_of(std::size_t method, const Experiment& experiment, std::span<const Cell> cells,
                     std::span<const CellResult> results) {
  Standing standing{.method = method, .fd = {}};
  for (std::size_t n = 0; n < experiment.noises.size(); ++n)
    standing.fd.push_back(spread_of(cells, results, "fd", [&](const Cell& cell) {
      return cell.method == method && cell.noise == n;
    }));
  double frames = 0, seconds = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].method != method) continue;
    standing.incomplete += is_incomplete(results[i]);
    if (!results[i].refused.empty()) continue;
    frames += static_cast<double>(results[i].frames);
    seconds += results[i].figure("seconds");
  }
  standing.frames_per_second = frames / seconds;
  return standing;
}

}  // namespace

Spread spread(std::span<const double> values) {
  double sum = 0, squares = 0;
  Index count = 0;
  for (const double x : values)
    if (!std::isnan(x)) sum += x, ++count;
  const double mean = sum / static_cast<double>(count);  // 0/0 is NaN
  for (const double x : values)
    if (!std::isnan(x)) squares += (x - mean) * (x - mean);
  const double sd = count == 1 ? 0 : std::sqrt(squares / static_cast<double>(count - 1));
  return {.mean = mean, .sd = count == 0 ? mean : sd, .count = count};
}

std::vector<Standing> ranking(const Experiment& experiment, std::span<const Cell> cells,
                              std::span<const CellResult> results) {
  std::vector<Standing> standings;
  for (std::size_t m = 0; m < experiment.methods.size(); ++m)
    standings.push_back(standing_of(m, experiment, cells, results));
  for (std::size_t t = 0; t < experiment.takes.size(); ++t)
    for (std::size_t n = 0; n < experiment.noises.size(); ++n) {
      const std::vector<double> own = levels(experiment, cells, results, t, n);
      const std::vector<double> place = places(own);
      for (std::size_t m = 0; m < standings.size(); ++m) {
        standings[m].mean_rank += place[m];
        standings[m].wins += std::isfinite(own[m]) && own[m] == std::ranges::min(own);
      }
    }
  const auto groups = static_cast<double>(experiment.takes.size() * experiment.noises.size());
  for (Standing& standing : standings) standing.mean_rank /= groups;
  std::ranges::stable_sort(standings, {}, &Standing::mean_rank);
  return standings;
}

std::string cells_csv(const Experiment& experiment, std::span<const Cell> cells,
                      std::span<const CellResult> results) {
  // Figures that came later stand behind everything else, so that columns keep their places.
  constexpr std::array<std::string_view, 2> later = {"strikes", "worst"};
  std::set<std::string> names;
  std::vector<std::string> appended;
  for (const CellResult& result : results)
    for (const auto& [name, value] : result.figures) names.insert(name);
  for (const std::string_view name : later)
    if (names.erase(std::string(name))) appended.emplace_back(name);

  std::string text = "take,noise,method,seed,noise_seed,frames";
  for (const std::string& name : names) text += "," + name;
  text += ",refused";
  for (const std::string& name : appended) text += "," + name;
  text += '\n';
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto& [take, noise, method, seed, own_seed] = cells[i];
    text += fmt::format("{},{},{},{},{},{}", quoted(experiment.takes[take].label),
                        quoted(experiment.noises[noise].label),
                        quoted(experiment.methods[method].label), experiment.seeds[seed], own_seed,
                        results[i].frames);
    for (const std::string& name : names) text += field(results[i].figure(name));
    text += ',';
    text += quoted(results[i].refused);
    for (const std::string& name : appended) text += field(results[i].figure(name));
    text += '\n';
  }
  return text;
}

}  // namespace moclean
