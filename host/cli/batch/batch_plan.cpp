#include "cli/batch/batch_plan.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/hash.hpp"
#include "moclean/core/parallel.hpp"
#include "moclean/formats/amc.hpp"
#include "moclean/formats/bvh.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/formats.hpp"
#include "moclean/run/truth.hpp"

namespace moclean::cli {
namespace {

namespace fs = std::filesystem;

std::string hash_text(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return "";
  return fmt::format("{:016x}", Fnv1a().bytes(read_file(file)).value());
}

// Leaves out the folder of results, and what earlier runs have put into the folders of takes.
class EarlierResults {
 public:
  EarlierResults(const DenoiseOptions& options) {
    for (const fs::path& place :
         {options.output, options.outliers, options.mask, options.sigma, options.report})
      if (!place.empty()) places_.insert(fs::weakly_canonical(place / "").parent_path());
    for (const fs::path& input : options.inputs)
      if (fs::is_directory(input)) inputs_.insert(fs::weakly_canonical(input));
    for (const fs::path& input : options.inputs)
      if (fs::is_directory(input)) learn(input);
  }

  bool operator()(const fs::path& found) {
    std::error_code error;
    if (!fs::is_directory(found, error)) return files_.contains(real_place(found));
    const fs::path real = fs::weakly_canonical(found);
    if (places_.contains(real) && !inputs_.contains(real)) return true;
    learn(found);
    return false;
  }

 private:
  static fs::path real_place(const fs::path& file) {
    return fs::weakly_canonical(file.parent_path()) / file.filename();
  }

  // What a manifest says was made of takes below an input is no input.
  void learn(const fs::path& folder) {
    std::error_code error;  // of a folder that cannot be read, say: who walks it tells of that
    if (!fs::exists(folder / manifest_name, error)) return;
    const Manifest manifest(folder);
    const auto add = [&](const std::vector<fs::path>& files) {
      for (const fs::path& file : files) files_.insert(real_place(file));
    };
    add(manifest.sides());
    for (const fs::path& input : inputs_) add(manifest.results_below(input));
  }

  std::set<fs::path> places_, inputs_, files_;
};

Json frames_record(const FrameRange& frames) {
  const auto end = [](const std::optional<Index>& frame) {
    return frame ? Json(*frame) : Json(nullptr);
  };
  return Json::array({end(frames.first), end(frames.last)});
}

// All that decides the results of a take but its input and the version of the program.
Json parameters_of(const DenoiseOptions& options, const OutputPlan& outputs, std::size_t take,
                   const std::string& skeleton_hash, const std::string& truth_hash) {
  const ReadOptions& reading = options.reading;
  Json record;
  record["method"] = to_string(options.chain);
  record["from_rotations"] = options.from_rotations;
  record["max_gap"] = options.max_gap ? Json(*options.max_gap) : Json(nullptr);
  record["keep_observed"] = options.keep_observed;
  record["frames"] = frames_record(reading.frames);
  record["rate"] = reading.rate;
  record["skeleton"] = skeleton_hash;
  record["layout"] = static_cast<int>(reading.layout);
  record["columns"] = reading.columns;
  record["missing"] = reading.missing;
  record["format"] = outputs.clean[take].extension().string();
  record["keep_raw"] = options.keep_raw;
  const bool on_device = needs_backend(options.chain);
  record["backend"] = on_device ? options.backend : "host";
  record["precision"] = to_string(options.precision);
  record["form"] = options.form ? Json(to_string(*options.form)) : Json(nullptr);
  record["products"] = options.products ? Json(to_string(*options.products)) : Json(nullptr);
  record["verified"] = options.verify;
  if (!outputs.reports.empty()) record["truth"] = truth_hash;
  if (!outputs.reports.empty() && options.truth_frames)
    record["truth_frames"] = frames_record(*options.truth_frames);
  return record;
}

// Hashes of files that many takes share, each computed once.
class SharedHashes {
 public:
  std::string of(const fs::path& file) {
    const auto [entry, is_new] = hashes_.try_emplace(file);
    if (is_new) entry->second = hash_text(file);
    return entry->second;
  }

 private:
  std::map<fs::path, std::string> hashes_;
};

void find_settings(const DenoiseLayers& layers, const std::vector<fs::path>& below,
                   BatchPlan& plan) {
  std::map<std::vector<std::size_t>, std::size_t> known = {{{}, 0}};
  for (const fs::path& take : below) {
    const std::vector<std::size_t> folders = layers.folders_of(take);
    const auto [setting, is_new] = known.emplace(folders, plan.settings.size());
    if (is_new) plan.settings.push_back(layers.options(folders));
    plan.setting_of.push_back(setting->second);
  }
}

OutputRequest request_of(const BatchPlan& plan) {
  const DenoiseOptions& options = plan.common();
  OutputRequest request{.inputs = options.inputs,
                        .files = plan.files,
                        .output = options.output,
                        .outliers = options.outliers,
                        .mask = options.mask,
                        .sigma = options.sigma,
                        .report = options.report,
                        .format = options.format,
                        .keep_raw = options.keep_raw,
                        .force = options.force,
                        .also_read = plan.truths};
  if (fs::is_directory(options.output))
    request.is_result = [manifest = std::make_shared<Manifest>(options.output)](
                            const fs::path& file) { return manifest->is_result(file); };
  for (std::size_t i = 0; i < plan.files.size(); ++i) {
    request.formats.push_back(plan.options_of(i).format);
    request.skeletons.push_back(plan.options_of(i).reading.skeleton);
    if (!request.skeletons.back().empty()) request.also_read.push_back(request.skeletons.back());
  }
  return request;
}

// AMC states no frame rate, and BVH has to; as losses() says it of one take.
void note_assumed_rate(BatchPlan& plan) {
  std::vector<fs::path> assumed;
  for (std::size_t i = 0; i < plan.files.size(); ++i)
    if (format_of(plan.files[i]) == &amc_format &&
        format_of(plan.outputs.clean[i]) == &bvh_format && plan.options_of(i).reading.rate == 0)
      assumed.push_back(plan.outputs.clean[i]);
  if (assumed.empty()) return;
  plan.outputs.notes.push_back(fmt::format(
      "{}: no frame rate is known: BVH states 120 Hz; --rate states another",
      assumed.size() == 1 ? assumed.front().string() : fmt::format("{} takes", assumed.size())));
}

void add_records(BatchPlan& plan) {
  SharedHashes hashes;
  for (std::size_t i = 0; i < plan.files.size(); ++i) {
    const DenoiseOptions& options = plan.options_of(i);
    const fs::path& given = options.reading.skeleton;
    const auto skeleton = skeleton_of(plan.files[i], given);
    const fs::path& used = skeleton ? *skeleton : given;
    const bool compared = !plan.truths.empty() && !plan.outputs.reports.empty();
    std::vector<fs::path> results = results_of(plan.outputs, i);
    if (plan.outputs.sources[i] != plan.files[i]) results.push_back(plan.outputs.sources[i]);
    plan.records.push_back(
        {.file = plan.files[i],
         .input = plan.outputs.sources[i],
         .outputs = std::move(results),
         .parameters = parameters_of(options, plan.outputs, i, used.empty() ? "" : hashes.of(used),
                                     compared ? hashes.of(plan.truths[i]) : "")});
  }
}

}  // namespace

bool BatchPlan::goes_on_after_failures() const {
  const std::vector<fs::path>& inputs = common().inputs;
  return !common().all_or_nothing && (inputs.size() > 1 || fs::is_directory(inputs.front()));
}

std::vector<std::vector<std::size_t>> BatchPlan::groups() const {
  std::vector<std::vector<std::size_t>> takes(settings.size());
  for (std::size_t i = 0; i < files.size(); ++i)
    if (!done[i]) takes[setting_of[i]].push_back(i);
  std::erase_if(takes, [](const auto& group) { return group.empty(); });
  return takes;
}

std::vector<fs::path> results_of(const OutputPlan& outputs, std::size_t take) {
  std::vector<fs::path> files = {outputs.clean[take]};
  for (const auto* sides : {&outputs.outliers, &outputs.masks, &outputs.sigmas, &outputs.reports})
    if (!sides->empty()) files.push_back((*sides)[take]);
  for (const FileCopy& copy : outputs.copies[take]) files.push_back(copy.to);
  return files;
}

BatchPlan plan_batch(const DenoiseLayers& layers, const DenoiseOptions& options) {
  BatchPlan plan;
  plan.settings = {options};
  EarlierResults earlier(options);
  plan.files = expand_folders(
      options.inputs, [&](const fs::path& path) { return earlier(path); },
      options.all_or_nothing ? nullptr : &plan.passed_by);
  if (plan.files.empty() && !plan.passed_by.problems.empty())
    throw Error(plan.passed_by.problems.front());
  std::vector<fs::path> below;
  const InputFolders folders(options.inputs);
  for (const fs::path& file : plan.files) below.push_back(folders.below(file));
  find_settings(layers, below, plan);
  plan.warnings = layers.unused(below);
  plan.warnings.insert(plan.warnings.end(), plan.passed_by.skipped.begin(),
                       plan.passed_by.skipped.end());
  if (!options.truth.empty()) plan.truths = truths_of(options.truth, plan.files, options.inputs);
  plan.outputs = plan_outputs(request_of(plan));
  note_assumed_rate(plan);
  add_records(plan);
  plan.done.resize(plan.files.size());
  if (options.all_or_nothing && plan.groups().size() > 1)
    throw ArgumentError(
        "--all-or-nothing solves all takes alike; the configuration has settings of folders");
  if (options.resume && plan.outputs.root.empty())
    throw ArgumentError(
        fmt::format("--resume needs a folder of results, {} is a file", options.output.string()));
  return plan;
}

void leave_out_done(const Manifest& manifest, BatchPlan& plan) {
  for_each_index(static_cast<Index>(plan.files.size()), plan.common().jobs, [&](Index i) {
    const auto take = static_cast<std::size_t>(i);
    plan.done[take] = manifest.is_done(plan.records[take]);
  });
}

}  // namespace moclean::cli
