#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "moclean/formats/format.hpp"

namespace moclean {

/// All formats, in the order in which texts list them and files of the same stem are looked for.
std::span<const Format* const> formats();

/// The format that the extension of a file stands for, in any case; null if none does.
const Format* format_of(const std::filesystem::path& file);

/// What may be asked of a format.
using FormatTrait = bool (*)(const Format&);
inline bool can_read(const Format& format) { return format.read != nullptr; }
inline bool can_write(const Format& format) { return format.write != nullptr; }
inline bool has_skeleton(const Format& format) { return format.content.skeleton; }

/// Whether positions can be written without rotations of a skeleton that makes them.
inline bool holds_any_samples(const Format& format) {
  return can_write(format) && !has_skeleton(format);
}

/// Whether the extension of a file stands for a format of which `trait` is true.
bool is_of_format(const std::filesystem::path& file, FormatTrait trait);

/// The extensions of the formats of which `trait` is true.
std::vector<std::string> extensions(FormatTrait trait);

/// Those, as help texts list them: `.bvh .amc .csv`.
std::string listed_extensions(FormatTrait trait);

/// Those, as sentences list them: `.bvh, .amc or .csv`.
std::string any_extension(FormatTrait trait);

}  // namespace moclean
