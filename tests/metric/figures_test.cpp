#include "moclean/metric/figures.hpp"

#include <map>
#include <set>
#include <string>

#include <gmock/gmock.h>

#include "moclean/metric/metric.hpp"
#include "moclean/metric/motion_error.hpp"
#include "moclean/metric/strikes.hpp"
#include "moclean/metric/touched.hpp"

namespace moclean {
namespace {

class Figures : public testing::Test {
 protected:
  static std::map<std::string, double> values(const Evaluation& evaluation) {
    std::map<std::string, double> found;
    for (const Figure& figure : figures())
      if (const auto value = figure.of(evaluation)) found[std::string(figure.name)] = *value;
    return found;
  }

  Recording clip(const Matrix& samples) const {
    return {.samples = samples,
            .columns = {"a.x", "a.y", "a.z", "b.x", "b.y", "b.z"},
            .frame_rate = 30,
            .unit = ""};
  }

  const Recording truth_ = clip(Matrix{{0, 0, 0, 0, 0, 1}, {0, 1, 0, 0, 1, 1}, {0, 3, 0, 0, 3, 1}});
  const Recording estimate_ =
      clip(Matrix{{0, 0, 0, 0, 0, 3}, {0, 1, 0, 0, 1, 1}, {1, 3, 0, 0, 3, 1}});
  const Matrix outliers_{{0, 0, 0, 0, 0, 2}, {0, 0, 5, 0, 0, 0}, {0, 0, 0, 0, 0, 0}};
  const Mask touched_ = truth_.samples.array() != estimate_.samples.array();
};

TEST_F(Figures, HaveNamesOfTheirOwn) {
  std::set<std::string_view> names;
  for (const Figure& figure : figures()) names.insert(figure.name);

  EXPECT_EQ(names.size(), figures().size());
}

TEST_F(Figures, AreThoseOfTheMetrics) {
  const std::vector<int> parents = {-1, 0};

  auto found = values({.truth = truth_,
                       .estimate = estimate_,
                       .touched = &touched_,
                       .outliers = &outliers_,
                       .parents = parents});

  EXPECT_EQ(found["fd"], frobenius_distance(truth_.samples, estimate_.samples));
  EXPECT_EQ(found["rmse_touched"], rmse_where(truth_.samples, estimate_.samples, touched_, true));
  EXPECT_EQ(found["rmse_untouched"], 0);
  EXPECT_EQ(found["position"], 0.5);
  EXPECT_EQ(found["li_position"], li_position_error(truth_, estimate_));
  EXPECT_EQ(found["bone_length"], bone_length_error(truth_, estimate_, parents));
  EXPECT_EQ(found["smoothness"], smoothness_error(estimate_));
  EXPECT_EQ(found["acceleration"], acceleration_error(truth_, estimate_));
  EXPECT_EQ(found["precision"], 0.5);
  EXPECT_EQ(found["recall"], 0.5);
  EXPECT_EQ(found["f1"], 0.5);
  EXPECT_EQ(found["worst"], 2);
  EXPECT_EQ(found["strikes"], strikes_kept(truth_, estimate_));
  EXPECT_EQ(found.size(), figures().size());
}

TEST_F(Figures, LeaveOutWhatTheyLackInputsFor) {
  Recording without_rate = truth_;
  without_rate.frame_rate = 0;

  const auto found = values({.truth = without_rate, .estimate = estimate_});

  for (const char* name :
       {"rmse_touched", "rmse_untouched", "bone_length", "precision", "recall", "f1", "strikes"})
    EXPECT_FALSE(found.contains(name)) << name;
  EXPECT_TRUE(found.contains("fd"));
}

}  // namespace
}  // namespace moclean
