#include "moclean/core/version.hpp"

namespace moclean {

std::string_view version() { return MOCLEAN_VERSION; }

}  // namespace moclean
