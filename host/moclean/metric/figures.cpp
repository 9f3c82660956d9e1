#include "moclean/metric/figures.hpp"

#include <array>

#include "moclean/metric/metric.hpp"
#include "moclean/metric/motion_error.hpp"
#include "moclean/metric/strikes.hpp"
#include "moclean/metric/touched.hpp"

namespace moclean {
namespace {

using Value = std::optional<double>;

Value rmse(const Evaluation& e, bool touched) {
  if (!e.touched) return std::nullopt;
  return rmse_where(e.truth.samples, e.estimate.samples, *e.touched, touched);
}

std::optional<Detection> detected(const Evaluation& e) {
  if (!e.touched || !e.outliers) return std::nullopt;
  return detection(*e.touched, *e.outliers, e.outlier_threshold);
}

constexpr std::string_view length = "length", per_frame = "length/frame^2", share = "";

constexpr std::array all_figures = {
    Figure{.name = "fd",
           .description = "FD: root mean square error of all entries",
           .unit = length,
           .of = [](const Evaluation& e) -> Value {
             return frobenius_distance(e.truth.samples, e.estimate.samples);
           }},
    Figure{.name = "rmse_touched",
           .description = "RMSE of the entries noise touched",
           .unit = length,
           .of = [](const Evaluation& e) { return rmse(e, true); }},
    Figure{.name = "rmse_untouched",
           .description = "RMSE of all others",
           .unit = length,
           .of = [](const Evaluation& e) { return rmse(e, false); }},
    Figure{.name = "position",
           .description = "mean distance of a joint",
           .unit = length,
           .of = [](const Evaluation& e) -> Value { return position_error(e.truth, e.estimate); }},
    Figure{
        .name = "li_position",
        .description = "position error of Li 2022",
        .unit = length,
        .of = [](const Evaluation& e) -> Value { return li_position_error(e.truth, e.estimate); }},
    Figure{.name = "bone_length",
           .description = "bone-length error of Li 2022",
           .unit = length,
           .of = [](const Evaluation& e) -> Value {
             if (e.parents.empty()) return std::nullopt;
             return bone_length_error(e.truth, e.estimate, e.parents);
           }},
    Figure{.name = "smoothness",
           .description = "smoothness error of Li 2022",
           .unit = per_frame,
           .of = [](const Evaluation& e) -> Value { return smoothness_error(e.estimate); }},
    Figure{
        .name = "acceleration",
        .description = "acceleration error",
        .unit = per_frame,
        .of = [](const Evaluation& e) -> Value { return acceleration_error(e.truth, e.estimate); }},
    Figure{.name = "precision",
           .description = "entries found that noise touched",
           .unit = share,
           .larger_is_better = true,
           .of = [](const Evaluation& e) -> Value {
             const auto d = detected(e);
             return d ? Value(d->precision()) : std::nullopt;
           }},
    Figure{.name = "recall",
           .description = "touched entries that were found",
           .unit = share,
           .larger_is_better = true,
           .of = [](const Evaluation& e) -> Value {
             const auto d = detected(e);
             return d ? Value(d->recall()) : std::nullopt;
           }},
    Figure{.name = "f1",
           .description = "harmonic mean of the two",
           .unit = share,
           .larger_is_better = true,
           .of = [](const Evaluation& e) -> Value {
             const auto d = detected(e);
             return d ? Value(d->f1()) : std::nullopt;
           }},
    Figure{
        .name = "worst",
        .description = "largest displacement of a joint",
        .unit = length,
        .of = [](const Evaluation& e) -> Value { return worst_displacement(e.truth, e.estimate); }},
    Figure{.name = "strikes",
           .description = "share kept of the ten hardest impacts",
           .unit = share,
           .larger_is_better = true,
           .of = [](const Evaluation& e) -> Value {
             if (!(e.truth.frame_rate > 0)) return std::nullopt;
             return strikes_kept(e.truth, e.estimate);
           }},
};

}  // namespace

std::span<const Figure> figures() { return all_figures; }

}  // namespace moclean
