#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/version.hpp"
#include "moclean/noise/motion_like.hpp"
#include "moclean/run/outputs.hpp"
#include "moclean/run/same_file.hpp"

#include "cli/backend/driver_check.hpp"
#include "cli/backend/tuning_cache.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/tuning_contest.hpp"
#include "cli/interrupt.hpp"
#include "cli/options/checks.hpp"
#include "cli/printing/say.hpp"

namespace moclean::cli {
namespace {

struct TuneOptions {
  std::string device;
  Index frames = 200;
  Index columns = 93;
  bool quick = false;
  std::filesystem::path json;  // "-": standard output; empty: none
};

void print_tried(const TriedTuning& tried) {
  const bool left_out = tried.repetitions == 0 && tried.result != TriedTuning::Result::wrong;
  say("{:<28}{:>10.2f} ms{:>8.3f}  {}{}\n", tried.choice, 1e3 * tried.seconds, tried.ratio,
      to_string(tried.result), left_out ? ", one run: too slow" : "");
  output_failure();  // shown as they come
}

Json record_of(const TuneOptions& options, Index segments, const DeviceInfo& device,
               const ContestReport& report, const std::filesystem::path& file) {
  Json record;
  record["version"] = version();
  record["device"] = device.name;
  record["platform"] = device.platform_name;
  record["driver"] = device.driver;
  record["workload"] = {
      {"segments", segments}, {"frames", options.frames}, {"columns", options.columns}};
  record["tried"] = Json::array();
  for (const TriedTuning& tried : report.tried)
    record["tried"].push_back({{"choice", tried.choice},
                               {"tuning", tuning_record(tried.tuning)},
                               {"seconds", tried.seconds},
                               {"ratio", tried.ratio},
                               {"repetitions", tried.repetitions},
                               {"result", to_string(tried.result)}});
  record["kept"] = tuning_record(report.best);
  record["file"] = file.string();
  return record;
}

ExitCode run(const TuneOptions& options) {
  require_driver();
  if (!options.json.empty() && options.json != "-") require_writable(options.json);
  const Device device(options.device);
  const auto file = tuning_file(device.info());
  if (file.empty())
    throw Error("there is no place for the tuning: neither XDG_CACHE_HOME nor HOME is set");

  const NamedFile written[] = {{"--json", options.json}, {"the tuning", file}};
  require_apart(written);
  const bool table = options.json != "-";
  const Index segments = options.quick ? 12 : 48;
  const ContestRules rules{.repetitions = options.quick ? 3 : 7, .quick = options.quick};
  if (table)
    say("{}: {} segments of {} frames x {} columns\n{:<28}{:>13}{:>8}  {}\n", device.info().name,
        segments, options.frames, options.columns, "choice", "median", "ratio",
        "result, to the default's");
  const Interrupt interrupt;
  const ContestReport report = find_best_tuning(
      device, motion_like(segments, options.frames, options.columns), rules,
      [&](const TriedTuning& tried) {
        if (table) print_tried(tried);
      },
      interrupt.token());
  if (interrupt.token().stop_requested()) throw Cancelled();
  write_tuning(file, device.info(), report.best);
  if (!options.json.empty())
    write_json(options.json, record_of(options, segments, device.info(), report, file));
  if (table) say("kept: {}\nin {}\n", to_string(report.best), file.string());
  return ExitCode::done;
}

}  // namespace

void add_tune(CLI::App& program, Action& action) {
  CLI::App& command =
      *program.add_subcommand("tune", "Find what makes a device fastest, and keep it");
  command.footer(
      "Ratios are to the choice it competes with, measured in turns; a better one has to save 3 "
      "%.\n"
      "Tiles, rows of a sweep, panel, queues and batch leave every bit of the results as it is;\n"
      "form, products and form of the eigensolver change them within the bounds of moclean\n"
      "denoise --verify.\n"
      "What is kept is for the device and its driver, in $XDG_CACHE_HOME/moclean or\n"
      "~/.cache/moclean; moclean denoise uses it unless told --no-tuning.\n\n"
      "Example:\n  moclean tune --device cpu");
  const auto options = std::make_shared<TuneOptions>();
  command.add_option("--device", options->device, "OpenCL device, as in moclean denoise")
      ->envname("MOCLEAN_DEVICE")
      ->type_name("SEL");
  command.add_option("--frames", options->frames, "Frames of the segments it is to be fast for")
      ->check(whole_number(2, 100'000))
      ->capture_default_str()
      ->type_name("N");
  command.add_option("--columns", options->columns, "Columns of the segments")
      ->check(whole_number(1, 1000))
      ->capture_default_str()
      ->type_name("N");
  command.add_flag("--quick", options->quick, "A few choices only, in some seconds");
  command.add_option("--json", options->json, "Write a record; - is standard output")
      ->type_name("FILE");
  command.callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace moclean::cli
