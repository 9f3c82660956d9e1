#include "moclean/formats/read_skeleton.hpp"

#include "moclean/formats/asf.hpp"
#include "moclean/formats/bvh.hpp"
#include "moclean/formats/extension.hpp"
#include "moclean/formats/find_skeleton.hpp"

namespace moclean {

std::optional<Skeleton> read_skeleton(const std::filesystem::path& file,
                                      const ReadOptions& options) {
  const std::string kind = extension(file);
  if (kind == ".bvh") return parse_bvh(read_file(file), file).skeleton;
  std::filesystem::path asf = options.skeleton;
  if (kind == ".amc" && asf.empty()) asf = find_skeleton(file);
  if (asf.empty()) return std::nullopt;
  return parse_asf(read_file(asf), asf).skeleton;
}

}  // namespace moclean
