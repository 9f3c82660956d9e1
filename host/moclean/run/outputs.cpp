#include "moclean/run/outputs.hpp"

#include <array>
#include <map>

#include <fmt/format.h>
#include <unistd.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/bvh.hpp"
#include "moclean/formats/extension.hpp"
#include "moclean/formats/formats.hpp"
#include "moclean/formats/npy.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

void require_writable_folder(const fs::path& folder, const fs::path& target) {
  if (!fs::is_directory(folder))
    throw FileError(target,
                    fmt::format("cannot be written: there is no folder {}", folder.string()));
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw FileError(
        target, fmt::format("cannot be written: no permission to write into {}", folder.string()));
}

// A folder that may have to be created: the nearest one that exists has to be writable.
void require_creatable_folder(const fs::path& folder) {
  const fs::path plain =
      folder.has_filename() ? folder : folder.parent_path();  // no slash at its end
  if (fs::exists(plain) && !fs::is_directory(plain))
    throw ArgumentError(fmt::format(
        "{} is a file; several inputs, or a folder of them, need a folder for the results",
        plain.string()));
  fs::path existing = fs::absolute(folder).lexically_normal();
  while (!fs::exists(existing)) existing = existing.parent_path();
  require_writable_folder(existing, folder);
}

bool names_folder(const fs::path& path) { return !path.has_filename() || fs::is_directory(path); }

bool wants_folder(const OutputRequest& request) {
  return request.inputs.size() > 1 || fs::is_directory(request.inputs.front()) ||
         names_folder(request.output);
}

// BVH can say the rotations of any skeleton, other formats those of their own files alone.
void require_rotations(const fs::path& input, const fs::path& output) {
  if (!is_of_format(output, has_skeleton) || format_of(input) == format_of(output)) return;
  const bool has_rotations = is_of_format(input, has_skeleton);
  if (has_rotations && format_of(output) == &bvh_format) return;
  throw ArgumentError(fmt::format(
      "{}: cannot hold the positions of {} without rotations of its own skeleton, expected {}{}",
      output.string(), input.string(), has_rotations ? ".bvh, " : "",
      any_extension(holds_any_samples)));
}

std::string extension_of_result(const fs::path& input, const std::string& format) {
  if (!format.empty()) return "." + format;
  return is_of_format(input, holds_any_samples) ? extension(input)
                                                : std::string(npy_format.extension);
}

std::vector<fs::path> reports_in(const fs::path& folder, const std::vector<fs::path>& results) {
  std::vector<fs::path> reports;
  for (const fs::path& result : results) reports.push_back(folder / (result.stem() += ".html"));
  return reports;
}

void require_writable_report(const fs::path& file) {
  if (extension(file) != ".html")
    throw ArgumentError(fmt::format("{}: a report is a file ending in .html", file.string()));
  require_writable(file);
}

std::vector<fs::path> files_in(const fs::path& folder, const OutputRequest& request,
                               const std::string& format) {
  std::map<fs::path, fs::path> inputs;
  std::vector<fs::path> results;
  for (const fs::path& input : request.files) {
    const fs::path name = input.stem().string() + extension_of_result(input, format);
    const auto [other, first] = inputs.emplace(input.stem(), input);
    if (!first)
      throw ArgumentError(fmt::format("{} and {} would both become {}; give them in two calls",
                                      other->second.string(), input.string(),
                                      (folder / input.stem()).string()));
    require_rotations(input, name);
    results.push_back(folder / name);
  }
  return results;
}

void require_format(const fs::path& file, const std::string& format) {
  require_writable_recording(file);
  if (!format.empty() && extension(file) != "." + format)
    throw ArgumentError(fmt::format("--format {} contradicts {}", format, file.string()));
}

// A matrix that is written beside the motion, under the option that asks for it.
struct SideOutput {
  const char* option;
  const fs::path& requested;  // file or folder; empty: not asked for
  std::vector<fs::path>& files;
};

std::array<SideOutput, 3> side_outputs(const OutputRequest& request, OutputPlan& plan) {
  return {SideOutput{"--outliers", request.outliers, plan.outliers},
          SideOutput{"--mask", request.mask, plan.masks},
          SideOutput{"--sigma", request.sigma, plan.sigmas}};
}

void require_different_files(const OutputRequest& request, OutputPlan& plan) {
  std::map<fs::path, const char*> options;
  for (const fs::path& file : plan.clean) options.emplace(fs::weakly_canonical(file), "-o");
  for (const SideOutput& side : side_outputs(request, plan))
    for (const fs::path& file : side.files) {
      const auto [other, is_new] = options.emplace(fs::weakly_canonical(file), side.option);
      if (!is_new)
        throw ArgumentError(fmt::format("{} and {} would both write {}", other->second, side.option,
                                        file.string()));
    }
}

}  // namespace

void require_writable(const fs::path& file) {
  if (fs::is_directory(file)) throw FileError(file, "cannot be written: it is a folder");
  require_writable_folder(folder_of(file), file);
}

void require_writable_recording(const fs::path& file) {
  if (!is_of_format(file, can_write))
    throw ArgumentError(fmt::format("{}: cannot write this format, expected {}", file.string(),
                                    any_extension(can_write)));
  require_writable(file);
}

OutputPlan plan_outputs(const OutputRequest& request) {
  OutputPlan plan;
  if (wants_folder(request)) {
    plan.clean = files_in(request.output, request, request.format);
    plan.folders.push_back(request.output);
    for (const SideOutput& side : side_outputs(request, plan)) {
      if (side.requested.empty()) continue;
      const bool has_rotations = is_of_format("x." + request.format, has_skeleton);
      side.files = files_in(side.requested, request, has_rotations ? "" : request.format);
      plan.folders.push_back(side.requested);
    }
    if (!request.report.empty()) {
      plan.reports = reports_in(request.report, plan.clean);
      plan.folders.push_back(request.report);
    }
    for (const fs::path& folder : plan.folders) require_creatable_folder(folder);
  } else {
    plan.clean = {request.output};
    require_format(request.output, request.format);
    require_rotations(request.inputs.front(), request.output);
    for (const SideOutput& side : side_outputs(request, plan)) {
      if (side.requested.empty()) continue;
      side.files = {side.requested};
      require_format(side.requested, request.format);
      if (!is_of_format(side.requested, holds_any_samples))
        throw ArgumentError(fmt::format("{}: holds rotations, {} needs {}", side.requested.string(),
                                        side.option, any_extension(holds_any_samples)));
    }
    if (!request.report.empty()) {
      plan.reports = {request.report};
      require_writable_report(request.report);
    }
  }
  require_different_files(request, plan);
  return plan;
}

}  // namespace moclean
