#include "moclean/denoise/moving_part.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "moclean/body/vanished.hpp"
#include "moclean/core/order_statistics.hpp"

namespace moclean {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
constexpr Index fewest_joints = 2;

// Makes joints of so many columns missing that were lost and written as zeros.
void drop_lost(const std::vector<Joint>& all, Index width, double frame_rate, Matrix& samples) {
  std::vector<Index> first;
  for (const Joint& joint : all)
    if (joint.columns == width) first.push_back(joint.first_column);
  const auto count = static_cast<Index>(first.size());
  if (count < fewest_joints) return;
  Matrix positions = Matrix::Zero(samples.rows(), 3 * count);  // a picture's points have no depth
  for (Index j = 0; j < count; ++j)
    positions.middleCols(3 * j, width) =
        samples.middleCols(first[static_cast<std::size_t>(j)], width);
  const Mask lost = vanished(body_take(positions, frame_rate));
  for (Index j = 0; j < count; ++j)
    for (Index i = 0; i < samples.rows(); ++i)
      if (lost(i, j))
        samples.row(i).segment(first[static_cast<std::size_t>(j)], width).fill(missing);
}

// Median and stillness of one column; nothing without a sample.
struct Middle {
  double value = 0;
  bool still = false;
};
std::optional<Middle> middle_of(const Matrix& samples, Index column) {
  std::vector<double> values;
  for (const double x : samples.col(column))
    if (!std::isnan(x)) values.push_back(x);
  if (values.empty()) return {};
  const auto [least, most] = std::ranges::minmax(values);
  return Middle{median(values), least == most};
}

// Columns of joints that move.
std::vector<Index> moving_columns(const std::vector<Joint>& all, const std::vector<bool>& still) {
  std::vector<Index> found;
  for (const Joint& joint : all) {
    bool moves = false;
    for (Index c = 0; c < joint.columns; ++c)
      moves = moves || !still[static_cast<std::size_t>(joint.first_column + c)];
    for (Index c = 0; moves && c < joint.columns; ++c) found.push_back(joint.first_column + c);
  }
  return found;
}

// What is taken from every column; see MovingPart.
Eigen::RowVectorXd centres(const std::vector<Joint>& all, const MovingPart& part) {
  Eigen::RowVectorXd centre = part.medians;
  std::array<std::vector<double>, 3> axes;
  for (const Index c : part.columns)
    for (const Joint& joint : all)
      if (joint.columns == 3 && c >= joint.first_column && c < joint.first_column + 3)
        axes[static_cast<std::size_t>(c - joint.first_column)].push_back(part.medians(c));
  for (const Joint& joint : all)
    for (std::size_t axis = 0; joint.columns == 3 && axis < 3 && !axes[axis].empty(); ++axis)
      centre(joint.first_column + static_cast<Index>(axis)) = median(axes[axis]);
  return centre;
}

// The unit in which squares of the samples and of what is left of them are normal numbers.
double unit_of(const Matrix& samples) {
  constexpr int most = 300;  // of 1023
  double largest = 0;
  for (const double x : samples.reshaped())
    if (!std::isnan(x)) largest = std::max(largest, std::abs(x));
  if (largest == 0) return 1;
  const int exponent = std::ilogb(largest);
  return std::abs(exponent) < most ? 1 : std::ldexp(1., exponent);
}

// The motion of the take, given that of the part.
Matrix motion_of(const Recording& take, const MovingPart& part, const Matrix& moved) {
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  Matrix motion(take.frames(), take.samples.cols());
  for (Index p = 0; p < moved.cols(); ++p) {
    const Index c = part.columns[static_cast<std::size_t>(p)];
    for (Index i = 0; i < take.frames(); ++i) {
      const double was = part.clip.samples(i, p), is = moved(i, p);
      const bool unchanged = std::abs(is - was) <= rounding * std::abs(was);
      motion(i, c) = unchanged ? take.samples(i, c) : is * part.unit + part.centre(c);
    }
  }
  for (Index c = 0; c < motion.cols(); ++c)
    if (part.still[static_cast<std::size_t>(c)]) motion.col(c).setConstant(part.medians(c));
  return motion;
}

}  // namespace

MovingPart moving_part(const Recording& take, bool find_lost) {
  const std::vector<Joint> all = joints(take);
  Matrix samples = take.samples;
  for (const Index width : {3, 2})
    if (find_lost) drop_lost(all, width, take.frame_rate, samples);
  MovingPart part{
      .clip = {}, .columns = {}, .medians = Eigen::RowVectorXd::Zero(samples.cols()), .centre = {}};
  for (Index c = 0; c < samples.cols(); ++c) {
    const auto middle = middle_of(samples, c);
    if (middle) part.medians(c) = middle->value;
    part.still.push_back(middle && middle->still);
  }
  part.columns = moving_columns(all, part.still);
  part.centre = centres(all, part);
  Recording clip = like(take, std::move(samples));
  clip.confidence = take.confidence;
  part.clip = columns_of(clip, part.columns);
  for (Index p = 0; p < part.clip.samples.cols(); ++p)
    part.clip.samples.col(p).array() -= part.centre(part.columns[static_cast<std::size_t>(p)]);
  part.unit = unit_of(part.clip.samples);
  part.clip.samples /= part.unit;
  return part;
}

void put_back(const Recording& take, const MovingPart& part, Denoised& result) {
  const Mask observed = !take.samples.array().isNaN();
  Mask trusted = take.samples.array() == part.medians.replicate(take.frames(), 1).array();
  Matrix sigma = trusted.select(Matrix::Zero(take.frames(), trusted.cols()), missing);
  for (std::size_t p = 0; p < part.columns.size(); ++p) {
    const Index c = part.columns[p];
    sigma.col(c) = part.unit * result.sigma->col(static_cast<Index>(p));
    if (part.still[static_cast<std::size_t>(c)]) continue;
    trusted.col(c) = result.trusted->col(static_cast<Index>(p));
  }
  result.motion = motion_of(take, part, result.motion);
  const Mask gross = observed && !trusted && !result.motion.array().isNaN();
  result.outliers = gross.select(take.samples - result.motion, 0);
  result.sigma = std::move(sigma);
  result.trusted = std::move(trusted);
}

}  // namespace moclean
