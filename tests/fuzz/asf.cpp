#include "moclean/formats/asf.hpp"

#include <optional>

#include "moclean/motion/recording.hpp"

#include "fuzz/memory_use.hpp"
#include "fuzz/target.hpp"
#include "fuzz/targets.hpp"

namespace moclean::fuzz {

void asf(std::string_view input) {
  std::optional<AcclaimSkeleton> read;
  const MemoryUse memory;
  succeeds([&] { read = parse_asf(input, "input.asf"); });
  memory.expect_within({}, input.size());
  if (!read) return;
  if (read->skeleton.bones.empty()) throw Violation("a skeleton has a root");
  for (const Bone& bone : read->skeleton.bones) expect_showable(bone.name);

  const Matrix rest = Matrix::Zero(1, read->skeleton.channels());
  const Recording pose = joint_positions({read->skeleton, rest, 0, "ASF units"});
  if (joint_parents(pose).size() != read->skeleton.bones.size())
    throw Violation("every bone is a joint");
}

}  // namespace moclean::fuzz
