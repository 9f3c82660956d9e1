#pragma once

#include <string_view>

#include "moclean/formats/bvh.hpp"
#include "moclean/formats/text_scanner.hpp"

namespace moclean {

/// Reads what stands behind MOTION into `motion`, whose skeleton is there, and where that is into
/// `document`. `scanner` walks through `text`; `rate` as in parse_bvh(). Throws FileError.
void read_bvh_motion(std::string_view text, TextScanner& scanner, double rate,
                     BvhDocument& document, SkeletonMotion& motion);

}  // namespace moclean
