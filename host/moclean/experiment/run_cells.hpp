#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "moclean/backend/backend.hpp"
#include "moclean/experiment/experiment.hpp"
#include "moclean/experiment/results.hpp"

namespace moclean {

/// How cells are computed.
struct CellRun {
  Backend* backend = nullptr;                     ///< may be null if no method needs one
  std::string program = {};                       ///< name and version, for keys
  std::string device = {};                        ///< what computes the matrix methods, for keys
  int jobs = 1;                                   ///< threads of filters
  std::uint64_t memory = std::uint64_t{1} << 30;  ///< bytes of the takes that are cleaned together
  CellResults* results =
      nullptr;           ///< finished cells are taken from here and kept here; may be null
  Monitor monitor = {};  ///< progress counts cells
};

/// The results of the cells, in their order.
///
/// The cells of one method, whatever their take, noise and seed, are cleaned together, as many as
/// the memory allows; the first calls are smaller, so that little is lost when a run is killed
/// early. Results do not depend on that, but for `seconds`. Methods that need every sample refuse a
/// take with missing ones, which is a result. Throws ArgumentError naming the take and the method
/// for a take without the frame rate that a method needs, and Cancelled; results of finished cells
/// are kept even then.
std::vector<CellResult> run_cells(const Experiment& experiment, std::span<const Cell> cells,
                                  const CellRun& run);

/// The figures of one estimate, see CellResult::figures; `seconds` is left out.
std::map<std::string, double, std::less<>> cell_figures(const ExperimentTake& take,
                                                        const Mask& touched,
                                                        const Denoised& estimate);

}  // namespace moclean
