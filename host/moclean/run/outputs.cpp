#include "moclean/run/outputs.hpp"

#include <array>
#include <cerrno>
#include <map>
#include <optional>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/amc.hpp"
#include "moclean/formats/bvh.hpp"
#include "moclean/formats/csv.hpp"
#include "moclean/formats/extension.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/formats.hpp"
#include "moclean/run/inputs.hpp"
#include "moclean/run/same_file.hpp"

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
  const bool is_there = fs::exists(plain);
  if (is_there ? !fs::is_directory(plain) : format_of(folder) != nullptr)
    throw ArgumentError(fmt::format(
        "{} {}; several inputs, or a folder of them, need a folder for the results{}",
        plain.string(), is_there ? "is a file" : "is the name of a file",
        is_there ? "" : fmt::format(" (a new one of that name is {}/)", plain.string())));
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

std::string format_of_file(const OutputRequest& request, std::size_t file) {
  return request.formats.empty() ? request.format : request.formats[file];
}

// `trait` is what the format has to be able to.
std::string extension_of_result(const fs::path& input, const std::string& format,
                                FormatTrait trait) {
  if (!format.empty() && is_of_format("x." + format, trait)) return "." + format;
  return is_of_format(input, trait) ? extension(input) : std::string(csv_format.extension);
}

// As fs::path::replace_extension(), but leaves an extension alone that is none of a format's:
// `walk.1` is `walk.1.html`.
fs::path with_extension(const fs::path& file, const std::string& extension) {
  return (file.parent_path() / file.stem()) += extension;
}

void require_writable_report(const fs::path& file) {
  if (extension(file) != ".html")
    throw ArgumentError(fmt::format("{}: a report is a file ending in .html", file.string()));
  require_writable(file);
}

std::vector<fs::path> files_in(const fs::path& folder, const OutputRequest& request,
                               FormatTrait trait) {
  const InputFolders folders(request.inputs);
  std::vector<fs::path> results;
  for (std::size_t i = 0; i < request.files.size(); ++i) {
    const fs::path& input = request.files[i];
    const std::string kind = extension_of_result(input, format_of_file(request, i), trait);
    // `Walk.BVH` stays `Walk.BVH`.
    const bool same = kind == extension(input);
    const fs::path below = folders.below(input);
    results.push_back(folder / (same ? below : with_extension(below, kind)));
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

// What writes a file: the input of which take, and the option that asks for it.
struct Writer {
  const fs::path& input;
  const char* option;
};

void require_different(const Writer& a, const Writer& b, const fs::path& file) {
  if (a.input == b.input)
    throw ArgumentError(
        fmt::format("{} and {} would both write {}", a.option, b.option, file.string()));
  throw ArgumentError(fmt::format("{} and {} would both become {}; give them in two calls",
                                  a.input.string(), b.input.string(), file.string()));
}

void require_different_files(const OutputRequest& request, OutputPlan& plan) {
  std::map<std::string, Writer> writers;
  const auto add = [&](const std::vector<fs::path>& files, const char* option) {
    for (std::size_t i = 0; i < files.size(); ++i) {
      const Writer writer{request.files[i], option};
      const std::string key = file_key(files[i]);
      if (key.empty()) continue;
      const auto [other, is_new] = writers.emplace(key, writer);
      if (!is_new) require_different(other->second, writer, files[i]);
    }
  };
  add(plan.clean, "-o");
  for (const SideOutput& side : side_outputs(request, plan)) add(side.files, side.option);
  add(plan.reports, "--report");
}

// Whether two names are those of one file that is there.
bool is_same(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::equivalent(a, b, error);
}

// Where a result has replaced its input, that is what was kept of it. A file that is neither is a
// newer input, and what was kept of an older one is not to be lost.
void keep_inputs(const OutputRequest& request, OutputPlan& plan) {
  for (std::size_t i = 0; i < request.files.size(); ++i) {
    const fs::path& input = request.files[i];
    const fs::path kept = plan.clean[i].parent_path() / raw_name(input.filename());
    if (!is_same(input, plan.clean[i]) || !fs::exists(kept)) {
      plan.copies[i].push_back({input, kept});
      continue;
    }
    if (!(request.is_result && request.is_result(input)) && read_file(input) != read_file(kept))
      throw ArgumentError(
          fmt::format("{} was kept of an earlier {}, which has changed since; move "
                      "one of them away",
                      kept.string(), input.filename().string()));
    plan.sources[i] = kept;
  }
}

// An .amc can be read with its .asf only.
void keep_skeletons(const OutputRequest& request, OutputPlan& plan) {
  for (std::size_t i = 0; i < request.files.size(); ++i) {
    if (format_of(plan.clean[i]) != &amc_format || !is_of_format(request.files[i], can_write))
      continue;
    std::optional<fs::path> skeleton = skeleton_of(
        request.files[i], request.skeletons.empty() ? fs::path() : request.skeletons[i]);
    if (!skeleton) continue;  // reading the take says why
    const fs::path beside = plan.clean[i].parent_path() / skeleton->filename();
    if (!is_same(*skeleton, beside)) plan.copies[i].push_back({*std::move(skeleton), beside});
  }
}

void require_no_input(const OutputRequest& request, const OutputPlan& plan) {
  std::map<std::string, const fs::path*> read;
  const auto add = [&](const std::vector<fs::path>& files) {
    for (const fs::path& file : files)
      if (const std::string key = file_key(file); !key.empty()) read.emplace(key, &file);
  };
  add(request.files);
  add(request.also_read);
  const auto require = [&](const fs::path& output, const fs::path* allowed) {
    const auto input = read.find(file_key(output));
    if (input == read.end() || (allowed && *input->second == *allowed)) return;
    throw ArgumentError(fmt::format(
        "{} is an input{}; --force replaces it, --keep-raw keeps it as {} beside the result",
        output.string(),
        *input->second == output ? "" : fmt::format(" ({})", input->second->string()),
        raw_name(output.filename()).string()));
  };
  for (std::size_t i = 0; i < plan.clean.size(); ++i)
    require(plan.clean[i], request.keep_raw ? &request.files[i] : nullptr);
  for (const auto* files : {&plan.outliers, &plan.masks, &plan.sigmas, &plan.reports})
    for (const fs::path& file : *files) require(file, nullptr);
  for (const auto& copies : plan.copies)
    for (const FileCopy& copy : copies) require(copy.to, nullptr);
}

void note_other_formats(const OutputRequest& request, OutputPlan& plan) {
  std::map<std::string, int> counts;
  for (std::size_t i = 0; i < request.files.size(); ++i)
    if (format_of_file(request, i).empty() && !is_of_format(request.files[i], can_write))
      ++counts[extension(request.files[i])];
  for (const auto& [kind, count] : counts)
    plan.notes.push_back(fmt::format("{} cannot be written: {} of such takes become{} {}", kind,
                                     count, count == 1 ? "s" : "", csv_format.extension));
}

std::set<fs::path> folders_of(const OutputPlan& plan) {
  std::set<fs::path> folders;
  for (const auto* files : {&plan.clean, &plan.outliers, &plan.masks, &plan.sigmas, &plan.reports})
    for (const fs::path& file : *files) folders.insert(file.parent_path());
  return folders;
}

void plan_in_folders(const OutputRequest& request, OutputPlan& plan) {
  plan.root = request.output;
  plan.clean = files_in(request.output, request, can_write);
  for (std::size_t i = 0; i < plan.clean.size(); ++i)
    require_rotations(request.files[i], plan.clean[i]);
  std::vector<fs::path> roots = {request.output};
  for (const SideOutput& side : side_outputs(request, plan)) {
    if (side.requested.empty()) continue;
    side.files = files_in(side.requested, request, holds_any_samples);
    roots.push_back(side.requested);
  }
  if (!request.report.empty()) {
    const InputFolders folders(request.inputs);
    for (const fs::path& file : request.files)
      plan.reports.push_back(request.report / with_extension(folders.below(file), ".html"));
    roots.push_back(request.report);
  }
  for (const fs::path& folder : roots) require_creatable_folder(folder);
  plan.folders = roots;
  for (const fs::path& folder : folders_of(plan)) plan.folders.push_back(folder);
  note_other_formats(request, plan);
}

void plan_single(const OutputRequest& request, OutputPlan& plan) {
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
  if (request.report.empty()) return;
  plan.reports = {request.report};
  require_writable_report(request.report);
}

}  // namespace

InputFolders::InputFolders(const std::vector<fs::path>& inputs) {
  for (const fs::path& input : inputs)
    if (fs::is_directory(input)) folders_.push_back((input / "").lexically_normal());
}

fs::path InputFolders::below(const fs::path& file) const {
  const fs::path plain = file.lexically_normal();
  for (const fs::path& folder : folders_) {
    const fs::path below = plain.lexically_relative(folder);
    if (!below.empty() && *below.begin() != ".." && below != ".") return below;
  }
  return file.filename();
}

void require_other_file(const fs::path& input, const fs::path& output) {
  const std::string key = file_key(input);
  if (!key.empty() && key == file_key(output))
    throw ArgumentError(fmt::format("{} is an input; --force replaces it", output.string()));
}

void require_writable(const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error)) throw FileError(file, "cannot be written: it is a folder");
  const auto place = place_of_new(file);
  if (place) require_writable_folder(folder_of(*place), file);
  if (access(file.c_str(), F_OK) == 0 ? access(file.c_str(), W_OK) != 0 : !place)
    throw FileError(file, "cannot be written: " + std::generic_category().message(errno));
}

void require_writable_recording(const fs::path& file) {
  if (!is_of_format(file, can_write))
    throw ArgumentError(fmt::format("{}: cannot write this format, expected {}", file.string(),
                                    any_extension(can_write)));
  require_writable(file);
}

OutputPlan plan_outputs(const OutputRequest& request) {
  OutputPlan plan;
  plan.sources = request.files;
  plan.copies.resize(request.files.size());
  wants_folder(request) ? plan_in_folders(request, plan) : plan_single(request, plan);
  require_different_files(request, plan);
  if (request.keep_raw) keep_inputs(request, plan);
  keep_skeletons(request, plan);
  if (!request.force) require_no_input(request, plan);
  return plan;
}

}  // namespace moclean
