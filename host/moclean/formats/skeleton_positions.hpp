#pragma once

#include <cstddef>
#include <filesystem>

#include "moclean/motion/recording.hpp"

namespace moclean {

/// joint_positions() of a motion that was read from `bytes` bytes of a file. Throws FileError where
/// they would take memory out of proportion to it: many joints without a channel, over many frames
/// (more than 64 MiB, and 64 bytes per byte of the file).
Recording skeleton_positions(SkeletonMotion motion, const std::filesystem::path& file,
                             std::size_t bytes);

}  // namespace moclean
