#include "moclean/denoise/denoiser.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/usable.hpp"

namespace moclean {

void require_usable(std::span<const Recording> takes, bool missing_accepted) {
  for (std::size_t t = 0; t < takes.size(); ++t) {
    const Matrix& samples = takes[t].samples;
    const std::vector<std::string>& columns = takes[t].columns;
    if (samples.size() == 0)
      throw ShapeError(fmt::format("take {} is empty ({} frames x {} columns)", t, samples.rows(),
                                   samples.cols()));
    if (static_cast<Index>(columns.size()) != samples.cols())
      throw ShapeError(
          fmt::format("take {} names {} columns but has {}", t, columns.size(), samples.cols()));
    const auto place =
        first_unusable(samples, missing_accepted, std::numeric_limits<double>::max());
    if (!place) continue;
    const auto [frame, column] = *place;
    const std::string& name = columns[static_cast<std::size_t>(column)];
    if (std::isinf(samples(frame, column)))
      throw TakeError(t, fmt::format("infinite at frame {}, column {}", frame, name));
    throw TakeError(t, fmt::format("not finite at frame {}, column {} (missing samples are not "
                                   "supported by this method)",
                                   frame, name));
  }
}

}  // namespace moclean
