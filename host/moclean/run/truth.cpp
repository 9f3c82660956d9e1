#include "moclean/run/truth.hpp"

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/formats.hpp"
#include "moclean/run/outputs.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;

fs::path truth_in(const fs::path& folder, const fs::path& file, const fs::path& below) {
  for (const fs::path& place : {folder / below.parent_path(), folder})
    for (const std::string& kind : extensions(can_read)) {
      const fs::path candidate = place / (file.stem() += kind);
      if (fs::exists(candidate)) return candidate;
    }
  throw FileError(folder, fmt::format("holds no truth of {}: expected {} with {}", file.string(),
                                      file.stem().string(), any_extension(can_read)));
}

}  // namespace

std::vector<fs::path> truths_of(const fs::path& truth, const std::vector<fs::path>& files,
                                const std::vector<fs::path>& inputs) {
  if (!fs::exists(truth)) throw FileError(truth, "there is no such file or folder");
  if (!fs::is_directory(truth)) {
    if (files.size() > 1)
      throw ArgumentError(fmt::format(
          "--truth {} is one file for {} inputs; give a folder of files named like them",
          truth.string(), files.size()));
    return {truth};
  }
  const InputFolders folders(inputs);
  std::vector<fs::path> truths;
  for (const fs::path& file : files) truths.push_back(truth_in(truth, file, folders.below(file)));
  return truths;
}

Recording read_truth(const fs::path& file, const ReadOptions& options, const Recording& noisy) {
  Recording truth = read_recording(file, options);
  if (truth.samples.rows() == noisy.samples.rows() && truth.samples.cols() == noisy.samples.cols())
    return truth;
  throw FileError(file, fmt::format("the truth has {} frames x {} columns, its input {} x {}; see "
                                    "--truth-frames",
                                    truth.samples.rows(), truth.samples.cols(),
                                    noisy.samples.rows(), noisy.samples.cols()));
}

}  // namespace moclean
