#include "report/sample_report.hpp"

#include <cmath>
#include <limits>

#include "moclean/core/random.hpp"

namespace moclean::test {
namespace {

Recording chain_walk(Index frames, Index joint_count) {
  Recording walk{.samples = Matrix(frames, 3 * joint_count),
                 .columns = default_column_names(3 * joint_count),
                 .frame_rate = 60,
                 .unit = "cm"};
  for (Index f = 0; f < frames; ++f)
    for (Index j = 0; j < joint_count; ++j) {
      const double t = static_cast<double>(f) / 20, at = static_cast<double>(j);
      walk.samples.row(f).segment(3 * j, 3) << 2 * t + std::sin(t + at), 3 * at + std::cos(t),
          std::sin(2 * t + at / 3);
    }
  return walk;
}

}  // namespace

ReportTake noisy_take(Index frames, Index joint_count) {
  const Recording walk = chain_walk(frames, joint_count);
  ReportTake take{.noisy = walk, .clean = walk, .truth = walk, .outliers = walk};
  take.outliers.samples.setZero();
  Random random(1);
  for (Index f = 0; f < frames; f += 3)
    for (Index c = 0; c < 3 * joint_count; ++c) {
      const double noise = random.normal();
      take.noisy.samples(f, c) += noise;
      take.clean.samples(f, c) += 0.1 * noise;
      take.outliers.samples(f, c) = 0.9 * noise;
    }
  return take;
}

Report sample_report(const std::string& title) {
  Report report{.title = title, .take = noisy_take(120, 10)};
  ReportTake& take = *report.take;
  for (int j = 0; j < 10; ++j) take.parents.push_back(j - 1);
  for (Matrix* samples : {&take.noisy.samples, &take.clean.samples, &take.outliers.samples})
    samples->block(20, 12, 10, 3).setConstant(std::numeric_limits<double>::quiet_NaN());
  for (Matrix* samples : {&take.noisy.samples, &take.outliers.samples})  // filled
    samples->block(35, 6, 2, 3).setConstant(std::numeric_limits<double>::quiet_NaN());
  take.sigma = Matrix::Constant(120, 30, 0.2);
  take.segments = {{0, 60, {.iterations = 38, .rank = 5, .residual = 9e-8, .converged = true}},
                   {60, 60, {.iterations = 1000, .rank = 7, .residual = 2e-3, .converged = false}}};
  report.parameters = {{"input", title}, {"method", "slra"}};
  report.tables = {{.title = "Ranking",
                    .note = "Mean over two seeds.",
                    .columns = {"method", "FD", "seconds"},
                    .rows = {{"slra", 0.11, 0.2},
                             {"<median>", 0.09, 0.01},
                             {"none", std::numeric_limits<double>::quiet_NaN(), 0.0}}}};
  return report;
}

}  // namespace moclean::test
