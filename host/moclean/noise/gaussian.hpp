#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "moclean/core/parameters.hpp"
#include "moclean/core/random.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// Gaussian noise of mean 0 on every entry. Exactly one of the two is given.
///
/// The signal of the signal-to-noise ratio is the motion: the variance of each column about its own
/// mean, averaged over the columns, so that the figure does not depend on where the origin is
/// (Li 2022 removes the mean pose for the same reason). sd = sqrt(variance / 10^(snr / 10)).
struct Gaussian {
  std::optional<double> sd = {};   ///< standard deviation in the unit of the clip, >= 0
  std::optional<double> snr = {};  ///< signal-to-noise ratio in dB

  bool operator==(const Gaussian&) const = default;

  static constexpr std::string_view name = "gaussian";
  static void visit(auto& self, auto& visitor) {
    visitor("sd", self.sd);
    visitor("snr", self.snr);
  }
};

/// Joints that vanish, frame by frame, before a background of noise (Li 2022): in every frame
/// `fraction` of the joints, rounded to whole joints and drawn anew, are set to zero or to NaN; all
/// other entries get Gaussian noise of the given ratio (see Gaussian).
struct Dropout {
  enum class Fill { zero, nan };
  enum class Background { gaussian, none };

  double fraction = 0.1;  ///< 0..1
  Fill fill = Fill::zero;
  Background background = Background::gaussian;
  double snr = 15;  ///< dB, of the background

  bool operator==(const Dropout&) const = default;

  static constexpr std::string_view name = "dropout";
  static constexpr std::array<std::string_view, 2> fills = {"zero", "nan"};
  static constexpr std::array<std::string_view, 2> backgrounds = {"gaussian", "none"};
  static void visit(auto& self, auto& visitor) {
    visitor("fraction", self.fraction);
    visitor("fill", self.fill, fills);
    visitor("background", self.background, backgrounds);
    visitor("snr", self.snr);
  }
};

/// Throws ArgumentError for parameters out of range.
void check(const Gaussian& noise);
void check(const Dropout& noise);

/// Adds the noise to the clip's samples and returns the entries it touched: every one of Gaussian,
/// those of vanished joints of Dropout, whose background counts as untouched. NaN stays NaN and
/// untouched. Draws do not depend on the samples.
Mask add_noise(const Gaussian& noise, Random& random, Recording& clip);
Mask add_noise(const Dropout& noise, Random& random, Recording& clip);

/// Standard deviation of noise of this ratio to the motion in the samples, see Gaussian.
double deviation_of(double snr, const Matrix& samples);

}  // namespace moclean
