#include "moclean/formats/formats.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "moclean/formats/amc.hpp"
#include "moclean/formats/bvh.hpp"
#include "moclean/formats/c3d.hpp"
#include "moclean/formats/csv.hpp"
#include "moclean/formats/extension.hpp"
#include "moclean/formats/mot.hpp"
#include "moclean/formats/npy.hpp"
#include "moclean/formats/npz.hpp"
#include "moclean/formats/trc.hpp"
#include "moclean/formats/tsv.hpp"

namespace moclean {

std::span<const Format* const> formats() {
  static constexpr std::array<const Format*, 11> all = {
      &bvh_format, &amc_format, &c3d_format, &trc_format, &csv_format, &tsv_format,
      &txt_format, &mot_format, &sto_format, &npy_format, &npz_format,
  };
  return all;
}

const Format* format_of(const std::filesystem::path& file) {
  const std::string kind = extension(file);
  const auto found = std::ranges::find(formats(), kind, &Format::extension);
  return found == formats().end() ? nullptr : *found;
}

bool is_of_format(const std::filesystem::path& file, FormatTrait trait) {
  const Format* format = format_of(file);
  return format && trait(*format);
}

std::vector<std::string> extensions(FormatTrait trait) {
  std::vector<std::string> found;
  for (const Format* format : formats())
    if (trait(*format)) found.emplace_back(format->extension);
  return found;
}

std::string listed_extensions(FormatTrait trait) {
  return fmt::format("{}", fmt::join(extensions(trait), " "));
}

std::string any_extension(FormatTrait trait) {
  const std::vector<std::string> all = extensions(trait);
  if (all.size() < 2) return listed_extensions(trait);
  return fmt::format("{} or {}", fmt::join(all.begin(), all.end() - 1, ", "), all.back());
}

}  // namespace moclean
