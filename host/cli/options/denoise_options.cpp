#include "cli/options/denoise_options.hpp"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "moclean/backend/opencl_backend.hpp"
#include "moclean/core/error.hpp"
#include "moclean/formats/formats.hpp"

#include "cli/nearest.hpp"
#include "cli/options/checks.hpp"
#include "cli/options/input_options.hpp"

namespace moclean::cli {
namespace {

constexpr const char* files_group = "Files";
constexpr const char* batch_group = "Many takes";
constexpr const char* report_group = "Report";

// The formats as --format names them.
std::vector<std::string> format_names(FormatTrait trait) {
  std::vector<std::string> names = extensions(trait);
  for (std::string& name : names) name.erase(0, 1);  // the dot
  return names;
}

void add_files(CLI::App& command, DenoiseOptions& options) {
  command
      .add_option("INPUT", options.inputs,
                  with_extensions("Recordings", can_read) +
                      ", or folders of them, searched to any depth; - is standard input")
      ->type_name("");
  command
      .add_option("-o,--output", options.output,
                  with_extensions("File", can_write) +
                      " for one input; folder, created if missing, for several; - is standard "
                      "output")
      ->type_name("OUTPUT")
      ->group(files_group);
  command
      .add_option("--outliers", options.outliers,
                  "Also write what was taken away; a folder when OUTPUT is one")
      ->type_name("FILE")
      ->group(files_group);
  command
      .add_option(
          "--mask", options.mask,
          "Also write what became of every sample: 0 kept, 1 corrected, 2 filled, 3 missing "
          "(docs/gaps.md); a folder when OUTPUT is one")
      ->type_name("FILE")
      ->group(files_group);
  command
      .add_option("--sigma", options.sigma,
                  "Also write the standard deviation of every sample, if the method has one; a "
                  "folder when OUTPUT is one")
      ->type_name("FILE")
      ->group(files_group);
  command
      .add_option(
          "--format", options.format,
          "Format of results in a folder or on standard output; otherwise that of the input if it "
          "can be written, else csv")
      ->check(one_of(format_names(can_write)))
      ->type_name("FORMAT")
      ->group(files_group);
  command
      .add_option("--input-format", options.input_format,
                  "Format of standard input; default: --format")
      ->check(one_of(format_names(can_read)))
      ->type_name("FORMAT")
      ->group(files_group);
  command
      .add_flag("--keep-raw", options.keep_raw,
                "Put every input beside its result, as NAME.raw.EXT; then a result may replace it")
      ->group(files_group);
  command.add_flag("--force", options.force, "A result may replace an input")->group(files_group);
  add_input_options(command, options.reading);
  for (const char* name :
       {"--frames", "--rate", "--skeleton", "--layout", "--columns", "--missing"})
    command.get_option(name)->group(files_group);
}

void add_segmentation(CLI::App& command, DenoiseOptions& options) {
  command
      .add_option(
          "--method", options.method_name,
          "Steps joined by +, each NAME or NAME:key=value,key=value (docs/methods.md); auto needs "
          "nothing, slra cuts a take into segments, rpca takes it whole")
      ->default_str("auto; slra with options of segments or of robust PCA")
      ->type_name("METHOD")
      ->group(method_group);
  auto* length = command
                     .add_option("--segment-length", options.segment_length,
                                 "Equal segments of about so many frames (not rpca)")
                     ->check(whole_number(1))
                     ->default_str("200")
                     ->type_name("N")
                     ->group(method_group);
  command.add_option("--segments", options.segments, "So many equal segments (not rpca)")
      ->check(whole_number(1))
      ->excludes(length)
      ->type_name("K")
      ->group(method_group);
  command
      .add_option("--overlap", options.segment_overlap,
                  "Frames that neighbouring segments share and that are blended (not rpca)")
      ->check(whole_number(0))
      ->default_str("0")
      ->type_name("FRAMES")
      ->group(method_group);
  command
      .add_option("--segment", options.division,
                  "Segments of equal length, or as many that end where it costs least (slra, "
                  "tslra; docs/segmentation.md)")
      ->check(one_of({"equal", "auto"}))
      ->capture_default_str()
      ->type_name("HOW")
      ->group(method_group);
}

void add_gaps(CLI::App& command, DenoiseOptions& options) {
  command
      .add_option("--max-gap", options.max_gap,
                  "Leave gaps missing that are longer than this, whatever the method fills")
      ->check(number_from_zero())
      ->type_name("SECONDS")
      ->group(method_group);
  command
      .add_flag("--from-rotations", options.from_rotations,
                "First take spikes of one or two frames out of the rotations of a BVH or AMC file, "
                "joint by joint; the method then works on the positions that remain")
      ->group(method_group);
  command
      .add_flag("--keep-observed", options.keep_observed,
                "Pass samples that were observed and not rejected through as they are")
      ->group(method_group);
}

void add_method(CLI::App& command, DenoiseOptions& options) {
  RobustPca& method = options.method;
  auto* lambda =
      command
          .add_option("--lambda", method.lambda,
                      "Weight of the outliers; default SCALE / sqrt(max(frames, columns))")
          ->check(positive_number())
          ->type_name("X");
  auto* scale = command.add_option("--lambda-scale", method.lambda_scale, "SCALE of that default")
                    ->excludes(lambda)
                    ->check(positive_number())
                    ->capture_default_str()
                    ->type_name("SCALE");
  auto* rho = command.add_option("--rho", method.rho, "Growth of mu per iteration, above 1")
                  ->check(number_above(1))
                  ->capture_default_str()
                  ->type_name("X");
  auto* tolerance =
      command.add_option("--tolerance", options.tolerance, "Relative residual to stop at")
          ->check(positive_number())
          ->default_str("1e-07, 1e-06 if mixed")
          ->type_name("X");
  auto* iterations =
      command.add_option("--max-iterations", method.max_iterations, "Iterations to stop at")
          ->check(whole_number(1, 1'000'000'000))
          ->capture_default_str()
          ->type_name("N");
  auto* order =
      command
          .add_option_function<std::string>(
              "--order", [&](const std::string& text) { method.order = parse_update_order(text); },
              "Update the motion first (ae, the paper) or the outliers first (ea)")
          ->check(one_of({"ae", "ea"}))
          ->default_str("ae")
          ->type_name("ORDER");
  for (CLI::Option* option : {lambda, scale, rho, tolerance, iterations, order})
    option->group(method_group);
}

void add_batch(CLI::App& command, DenoiseOptions& options) {
  command
      .add_option(
          "--config", options.config,
          "Settings of a run, also per folder (docs/batches.md); the command line overrides "
          "them")
      ->type_name("FILE.toml")
      ->group(batch_group);
  command
      .add_flag(
          "--resume", options.resume,
          "Leave out takes of which moclean.manifest.jsonl in OUTPUT says that they are done: "
          "same input, options and version, results as they were written")
      ->group(batch_group);
  command
      .add_flag("--all-or-nothing", options.all_or_nothing,
                "Write nothing if a take fails; otherwise the others of several are written")
      ->group(batch_group);
  command
      .add_flag("--dry-run", options.dry_run,
                "Say what would be done and to which file, do nothing")
      ->group(batch_group);
}

void add_overlap(CLI::App& command, DenoiseOptions& options) {
  command
      .add_flag_callback(
          "--no-overlap", [&] { options.overlap = false; },
          "Read all, then solve all, then write all, in any amount of memory: to measure the three")
      ->group(backend_group);
}

void add_truth(CLI::App& command, DenoiseOptions& options) {
  command
      .add_option("--report", options.report,
                  "Write an HTML page to look at: player, curves, heat map, figures; a folder when "
                  "OUTPUT is one")
      ->type_name("FILE.html")
      ->group(report_group);
  auto* truth = command
                    .add_option("--truth", options.truth,
                                "Recording without noise to compare with; for several inputs a "
                                "folder of files named like them. Its skeleton serves the report")
                    ->type_name("FILE")
                    ->group(report_group);
  command
      .add_option_function<std::string>(
          "--truth-frames",
          [&](const std::string& text) {
            options.truth_frames = parse_frame_range(text, "--truth-frames");
          },
          "Frames of the truth; default: --frames, of inputs and truth alike")
      ->needs(truth)
      ->type_name("A:B")
      ->group(report_group);
}

void add_report(CLI::App& command, DenoiseOptions& options) {
  command.add_option("--json", options.json, "Write a record of the run; - is standard output")
      ->type_name("FILE")
      ->group(report_group);
  command
      .add_option("--lines", options.lines,
                  "Write a line of JSON per take, as soon as it is done; - is standard output")
      ->type_name("FILE")
      ->group(report_group);
  command
      .add_flag("--verify", options.verify,
                "Solve with the reference, too; a take for which they differ fails")
      ->group(report_group);
  command
      .add_flag("--profile", options.profile,
                "Measure every kernel of the OpenCL device: calls, time, rates, share of the peak")
      ->group(report_group);
  command
      .add_flag("--quiet", options.quiet,
                "Print nothing but what changed much, warnings and errors")
      ->group(report_group);
}

void require_opencl(const DenoiseOptions& options) {
  if (options.backend == "opencl") return;
  if (options.verify)
    throw ArgumentError("--verify compares with the reference and needs --backend opencl");
  if (options.profile) throw ArgumentError("--profile needs --backend opencl");
}

// The options of a method that stands in no step of the chain would have no effect.
void require_used(const DenoiseOptions& options) {
  bool robust_pca = false, segmented = false, overlapping = false, automatic = false;
  for (const Step& step : options.chain) {
    const auto* low_rank = std::get_if<LowRank>(&step);
    if (!low_rank) continue;
    const bool is_robust_pca = std::holds_alternative<RobustPca>(low_rank->method);
    robust_pca = robust_pca || is_robust_pca;
    segmented = segmented || !(is_robust_pca && low_rank->segmentation.whole);
    overlapping = overlapping || low_rank->segmentation.overlap > 0;
    automatic = automatic || low_rank->segmentation.cheapest;
  }
  if (!segmented && (options.segment_length || options.segments))
    throw ArgumentError(
        "rpca and filters take every recording whole; --segment-length and --segments belong to "
        "--method slra, tslra, tsvd, svt and completion");
  if (options.segment_overlap.value_or(0) > 0 && !overlapping)
    throw ArgumentError(
        "--overlap is that of segments: it belongs to --method slra and tslra, and to tsvd, svt "
        "and "
        "completion with --segment-length or --segments");
  if (options.division == "auto" && !automatic)
    throw ArgumentError("--segment auto belongs to --method slra and tslra");
  if (!robust_pca && (options.tolerance || options.method != RobustPca{}))
    throw ArgumentError(fmt::format(
        "--lambda, --lambda-scale, --rho, --tolerance, --max-iterations and --order belong to "
        "--method slra and rpca; the settings of others follow their names (--method {}:key=value)",
        name_of(options.chain.front())));
}

// What a command line without --method means.
std::string default_method(const DenoiseOptions& options) {
  const bool of_segments = options.segment_length || options.segments || options.segment_overlap ||
                           options.division != "equal";
  const bool of_robust_pca =
      options.tolerance || options.method != RobustPca{} || options.precision == Precision::mixed;
  return of_segments || of_robust_pca ? "slra" : "auto";
}

void require_device_work(const DenoiseOptions& options) {
  if (needs_backend(options.chain)) return;
  if (options.verify)
    throw ArgumentError("--verify needs a method that runs on the device; filters run on the host");
  if (options.profile)
    throw ArgumentError(
        "--profile needs a method that runs on the device; filters run on the host");
}

void require_sigma(const DenoiseOptions& options) {
  if (!options.sigma.empty() && !has_sigma(options.chain))
    throw ArgumentError(fmt::format("--sigma: method {} has no standard deviation per sample",
                                    to_string(options.chain)));
}

// Before the method is parsed, whose message lists all steps: who mistyped one wants the nearest.
void require_known_steps(std::string_view method) {
  const std::vector<std::string_view> views = step_names();
  const std::vector<std::string> names(views.begin(), views.end());
  while (!method.empty()) {
    const std::string_view step = method.substr(0, method.find('+'));
    const std::string_view name = step.substr(0, step.find(':'));
    if (std::ranges::find(names, name) == names.end())
      if (const std::string guess = did_you_mean(name, names); !guess.empty())
        throw ArgumentError(fmt::format("unknown method '{}', expected one of {}{}", name,
                                        fmt::join(names, ", "), guess));
    method.remove_prefix(std::min(method.size(), step.size() + 1));
  }
}

void require_files(const DenoiseOptions& options) {
  if (options.inputs.empty())
    throw ArgumentError(
        "INPUT is required: recordings or folders of them (see moclean denoise "
        "--help)");
  if (options.output.empty())
    throw ArgumentError(
        "-o OUTPUT is required: a file, for several inputs a folder (see moclean "
        "denoise --help)");
  if (options.json == "-" && options.lines == "-")
    throw ArgumentError("--json - and --lines - would both write to standard output");
  if (options.output == "-" && (options.json == "-" || options.lines == "-"))
    throw ArgumentError(
        "-o - writes the recording to standard output; give --json and --lines a "
        "file");
}

std::optional<Segmentation> segmentation_given(const DenoiseOptions& options) {
  if (options.segment_length) return Segmentation{.length = *options.segment_length};
  if (options.segments) return Segmentation{.segments = *options.segments};
  return std::nullopt;
}

}  // namespace

void add_denoise_options(CLI::App& command, DenoiseOptions& options) {
  add_files(command, options);
  add_segmentation(command, options);
  add_gaps(command, options);
  add_method(command, options);
  add_backend_options(command, options);
  add_overlap(command, options);
  add_truth(command, options);
  add_report(command, options);
  add_batch(command, options);
}

void complete(DenoiseOptions& options) {
  require_files(options);
  require_opencl(options);
  complete_backend(options);
  const bool mixed = options.precision == Precision::mixed;
  if (options.method_name.empty()) options.method_name = default_method(options);
  RobustPca defaults = options.method;
  defaults.tolerance = options.tolerance.value_or(mixed ? mixed_tolerance : RobustPca{}.tolerance);
  if (mixed && defaults.tolerance < mixed_tolerance)
    throw ArgumentError("--precision mixed reaches a tolerance of 1e-06 at best");
  check(defaults);
  require_known_steps(options.method_name);
  options.chain = parse_chain(options.method_name,
                              {defaults, segmentation_given(options),
                               options.segment_overlap.value_or(0), options.division == "auto"});
  require_used(options);
  require_device_work(options);
  require_sigma(options);
  const LowRank* method = first_low_rank(options.chain);
  options.segmentation = method ? method->segmentation : Segmentation{.whole = true};
  const auto* robust_pca = method ? std::get_if<RobustPca>(&method->method) : nullptr;
  options.method = robust_pca ? *robust_pca : defaults;
}

}  // namespace moclean::cli
