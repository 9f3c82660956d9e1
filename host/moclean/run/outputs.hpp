#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace moclean {

/// Where the results of a run go.
struct OutputPlan {
  std::vector<std::filesystem::path> clean = {};     ///< one per input
  std::vector<std::filesystem::path> outliers = {};  ///< one per input; empty if not asked for
  std::vector<std::filesystem::path> masks = {};     ///< as `outliers`
  std::vector<std::filesystem::path> sigmas = {};    ///< as `outliers`
  std::vector<std::filesystem::path> reports = {};   ///< one per input; empty if not asked for
  std::vector<std::filesystem::path> folders = {};   ///< to be created before anything is written
};

/// What the user said about the results.
struct OutputRequest {
  std::vector<std::filesystem::path> inputs;  ///< as given: files and folders
  std::vector<std::filesystem::path> files;   ///< inputs with the folders expanded
  std::filesystem::path output;               ///< file or folder
  std::filesystem::path outliers;             ///< file or folder like `output`; may be empty
  std::filesystem::path mask = {};            ///< as `outliers`
  std::filesystem::path sigma = {};           ///< as `outliers`
  std::filesystem::path report;               ///< as `outliers`
  std::string format;                         ///< extension without dot; empty: by the name
};

/// Decides on every output before anything is computed and checks that it can be written.
///
/// `output` is a folder if there are several inputs or one that is a folder, if it ends with a
/// slash, or if it is a folder already. A file in it is named after its input; its format is
/// `format`, else the input's if that can be written and
/// holds any samples, else .npy (for BVH, too); a report in its folder is .html.
/// Throws ArgumentError for an extension that cannot be written and for two results of the same
/// name, FileError for a place that cannot be written.
OutputPlan plan_outputs(const OutputRequest& request);

/// Throws ArgumentError unless the file's extension is of a format that can be written, and
/// FileError unless its folder exists and can be written.
void require_writable_recording(const std::filesystem::path& file);

/// Throws FileError unless the file's folder exists and can be written.
void require_writable(const std::filesystem::path& file);

}  // namespace moclean
