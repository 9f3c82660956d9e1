#include "moclean/methods/robust_pca/robust_pca.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

using testing::ThrowsMessage;

void expect_refused(const RobustPca& method, const std::string& message) {
  EXPECT_THAT([&] { check(method); }, ThrowsMessage<ArgumentError>(message));
}

TEST(RobustPca, DefaultsAreValid) { EXPECT_NO_THROW(check(RobustPca{})); }

TEST(RobustPca, RefusesEveryParameterOutOfItsRange) {
  expect_refused({.lambda = -1}, "lambda is -1, expected a positive number, or 0 for automatic");
  expect_refused({.lambda_scale = 0}, "lambda-scale is 0, expected a positive number");
  expect_refused({.rho = 1}, "rho is 1, expected a number above 1");
  expect_refused({.mu0_factor = 0}, "mu0-factor is 0, expected a positive number");
  expect_refused({.mu_max_factor = 0.5}, "mu-max-factor is 0.5, expected a number of at least 1");
  expect_refused({.tolerance = 0}, "tolerance is 0, expected a positive number");
  expect_refused({.max_iterations = 0}, "max-iterations is 0, expected at least 1");
}

TEST(RobustPca, RefusesParametersThatAreNotFinite) {
  expect_refused({.rho = std::nan("")}, "rho is nan, expected a number above 1");
  expect_refused({.tolerance = INFINITY}, "tolerance is inf, expected a positive number");
}

TEST(LambdaOf, IsOneOverTheRootOfTheLongerSide) {
  EXPECT_EQ(lambda_of({}, 400, 93), 1.0 / 20);
  EXPECT_EQ(lambda_of({}, 25, 100), 1.0 / 10);
  EXPECT_EQ(lambda_of({.lambda_scale = 3}, 400, 93), 3.0 / 20);
}

TEST(LambdaOf, PrefersAnAbsoluteValue) {
  EXPECT_EQ(lambda_of({.lambda = 0.3, .lambda_scale = 3}, 400, 93), 0.3);
}

TEST(UpdateOrder, ReadsBackWhatItPrints) {
  EXPECT_EQ(parse_update_order(to_string(UpdateOrder::ae)), UpdateOrder::ae);
  EXPECT_EQ(parse_update_order(to_string(UpdateOrder::ea)), UpdateOrder::ea);
  EXPECT_EQ(to_string(UpdateOrder::ea), "ea");
}

TEST(UpdateOrder, RefusesAnythingElse) {
  EXPECT_THAT([] { parse_update_order("AE"); },
              ThrowsMessage<ArgumentError>("order is 'AE', expected ae or ea"));
}

}  // namespace
}  // namespace moclean
