#pragma once

#include <filesystem>
#include <optional>

#include "moclean/formats/format.hpp"
#include "moclean/motion/skeleton.hpp"

namespace moclean {

/// The skeleton of a recording: that of a .bvh itself, that of the .asf of an .amc (see
/// ReadOptions). Files of other formats have none of their own; for them it is options.skeleton if
/// that is given, else nothing. Throws FileError as read_clip().
std::optional<Skeleton> read_skeleton(const std::filesystem::path& file,
                                      const ReadOptions& options = {});

}  // namespace moclean
