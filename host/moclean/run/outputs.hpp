#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace moclean {

/// A file that is put beside a result as it is.
struct FileCopy {
  std::filesystem::path from;
  std::filesystem::path to;
};

/// Where the results of a run go.
struct OutputPlan {
  /// One per input, what is read for it: the input, or what an earlier run has kept of it where the
  /// result replaces it.
  std::vector<std::filesystem::path> sources = {};
  std::vector<std::filesystem::path> clean = {};     ///< one per input
  std::vector<std::filesystem::path> outliers = {};  ///< one per input; empty if not asked for
  std::vector<std::filesystem::path> masks = {};     ///< as `outliers`
  std::vector<std::filesystem::path> sigmas = {};    ///< as `outliers`
  std::vector<std::filesystem::path> reports = {};   ///< one per input; empty if not asked for
  std::vector<std::vector<FileCopy>> copies = {};    ///< per input; empty where there are none
  std::vector<std::filesystem::path> folders = {};   ///< to be created before anything is written
  std::filesystem::path root = {};  ///< the folder of the results; empty: `clean` is a single file
  std::vector<std::string> notes = {};  ///< per kind what the results do not keep of the inputs
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
  std::vector<std::string> formats = {};      ///< one per file, in place of `format`; may be empty
  std::vector<std::filesystem::path> skeletons = {};  ///< one per file, as ReadOptions::skeleton
  bool keep_raw = false;  ///< put every input beside its result, under its raw_name()
  bool force = false;     ///< a result may replace an input
  /// Whether a file is, to the byte, the result of an earlier run; not given: none is.
  std::function<bool(const std::filesystem::path&)> is_result = {};
  std::vector<std::filesystem::path> also_read = {};  ///< other files that no result may replace
};

/// Decides on every output before anything is computed and checks that it can be written.
///
/// `output` is a folder if there are several inputs or one that is a folder, if it ends with a
/// slash, or if it is a folder already. A file in it stands where its input does below the folder
/// that was given and is named after it; its format is `format`, else the input's if that can be
/// written, else .csv; what is no motion (outliers, masks, sigmas) keeps to formats that hold any
/// samples; a report is .html. Beside a result with rotations of a skeleton in a file of its own
/// (.amc) stands that file (.asf).
///
/// Throws ArgumentError for an extension that cannot be written, for two results of the same name,
/// for a folder of results that has the name of a file, for a result that is an input (by whatever
/// name) unless `force` or `keep_raw` allow it, and for a kept input that is not the one of a
/// result in its place; FileError for a place that cannot be written.
OutputPlan plan_outputs(const OutputRequest& request);

/// The folders among the inputs of a run.
class InputFolders {
 public:
  explicit InputFolders(const std::vector<std::filesystem::path>& inputs);

  /// The path of a file below the first of the folders that it is in; its name if it was given
  /// itself.
  std::filesystem::path below(const std::filesystem::path& file) const;

 private:
  std::vector<std::filesystem::path> folders_;
};

/// Throws ArgumentError unless the file's extension is of a format that can be written, and
/// FileError unless its folder exists and can be written.
void require_writable_recording(const std::filesystem::path& file);

/// Throws ArgumentError if the two are one file, also through links.
void require_other_file(const std::filesystem::path& input, const std::filesystem::path& output);

/// Throws FileError unless the file's folder exists and can be written; of a file, device or pipe
/// that is there, unless that can be written.
void require_writable(const std::filesystem::path& file);

}  // namespace moclean
