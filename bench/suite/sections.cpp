#include "suite/sections.hpp"

#include <cstdlib>

namespace moclean::bench {

const std::vector<Section>& sections() {
  static const std::vector<Section> all = {
      {"limits", measure_limits},     {"takes", measure_takes},
      {"segments", measure_segments}, {"batch_size", measure_batch_size},
      {"frames", measure_frames},     {"columns", measure_columns},
      {"products", measure_products}, {"precision", measure_precision},
      {"kernels", measure_kernels},   {"eigensolver", measure_eigensolver},
      {"threads", measure_threads},   {"start_up", measure_start_up},
      {"memory", measure_memory}};
  return all;
}

std::string device_selection() {
  const char* selection = std::getenv("MOCLEAN_DEVICE");
  return selection ? selection : "";
}

}  // namespace moclean::bench
