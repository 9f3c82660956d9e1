#include "moclean/formats/read_write.hpp"

#include <string>

#include "moclean/core/error.hpp"
#include "moclean/formats/amc.hpp"
#include "moclean/formats/asf.hpp"
#include "moclean/formats/bvh.hpp"
#include "moclean/formats/csv.hpp"
#include "moclean/formats/extension.hpp"
#include "moclean/formats/find_skeleton.hpp"
#include "moclean/formats/npy.hpp"

namespace moclean {
namespace {

Clip read_amc(const std::filesystem::path& file, const std::filesystem::path& skeleton) {
  const std::string motion = read_file(file);
  const std::filesystem::path asf = skeleton.empty() ? find_skeleton(file) : skeleton;
  return joint_positions(parse_amc(motion, file, parse_asf(read_file(asf), asf)));
}

Clip read_by_extension(const std::filesystem::path& file, const ReadOptions& options) {
  const std::string kind = extension(file);
  if (kind == ".bvh") return joint_positions(parse_bvh(read_file(file), file));
  if (kind == ".amc") return read_amc(file, options.skeleton);
  if (kind == ".csv") return parse_csv(read_file(file), file);
  if (kind == ".npy") return parse_npy(read_file(file), file);
  throw FileError(file, "expected a file ending in .bvh, .amc, .csv or .npy");
}

}  // namespace

Clip read_clip(const std::filesystem::path& file, const ReadOptions& options) {
  Clip clip = read_by_extension(file, options);
  if (clip.frame_rate == 0) clip.frame_rate = options.rate;
  return clip;
}

void write_clip(const std::filesystem::path& file, const Clip& clip) {
  write_temporary(file, clip).commit();
}

AtomicFile write_temporary(const std::filesystem::path& file, const Clip& clip) {
  const std::string kind = extension(file);
  if (kind != ".csv" && kind != ".npy")
    throw FileError(file, "cannot be written: expected a name ending in .csv or .npy");
  AtomicFile target(file);
  kind == ".csv" ? write_csv(target, clip) : write_npy(target, clip);
  target.close();
  return target;
}

}  // namespace moclean
