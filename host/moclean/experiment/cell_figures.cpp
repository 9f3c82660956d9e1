#include <algorithm>
#include <cctype>

#include "moclean/experiment/run_cells.hpp"
#include "moclean/metric/figures.hpp"

namespace moclean {
namespace {

std::string lower_case(std::string text) {
  for (char& letter : text)
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return text;
}

bool is_excluded(const std::string& name, const std::vector<std::string>& fragments) {
  return std::ranges::any_of(fragments, [own = lower_case(name)](const std::string& fragment) {
    return own.find(lower_case(fragment)) != own.npos;
  });
}

// What is measured: columns, and the parents of the joints they belong to.
struct Measured {
  std::vector<Index> columns;
  std::vector<int> parents;
};

// A joint whose parent is left out has no bone.
Measured measured(const ExperimentTake& take) {
  const std::vector<Joint> all = joints(take.clip);
  std::vector<int> places(all.size(), -1);
  Measured result;
  int place = 0;
  for (std::size_t j = 0; j < all.size(); ++j) {
    if (is_excluded(all[j].name, take.excluded)) continue;
    places[j] = place++;
    for (Index c = 0; c < all[j].columns; ++c) result.columns.push_back(all[j].first_column + c);
    if (take.parents.empty()) continue;
    const int parent = take.parents.at(j);
    result.parents.push_back(parent < 0 ? -1 : places[static_cast<std::size_t>(parent)]);
  }
  return result;
}

}  // namespace

std::map<std::string, double, std::less<>> cell_figures(const ExperimentTake& take,
                                                        const Mask& touched,
                                                        const Denoised& estimate) {
  const auto [columns, parents] = measured(take);
  const Recording truth = columns_of(take.clip, columns);
  const Recording cleaned = columns_of(like(take.clip, estimate.motion), columns);
  const Matrix outliers = estimate.outliers(Eigen::all, columns);
  const Mask mask = touched(Eigen::all, columns);

  std::map<std::string, double, std::less<>> values;
  const auto missing = cleaned.samples.array().isNaN();
  values["missing"] =
      static_cast<double>(missing.count()) / static_cast<double>(cleaned.samples.size());
  if (missing.all()) return values;
  const Evaluation evaluation{truth, cleaned, &mask, &outliers, parents};
  for (const Figure& figure : figures())
    if (const auto value = figure.of(evaluation)) values[std::string(figure.name)] = *value;
  return values;
}

}  // namespace moclean
