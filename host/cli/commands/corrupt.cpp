#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/formats.hpp"
#include "moclean/formats/read_write.hpp"
#include "moclean/formats/temporary_name.hpp"
#include "moclean/metric/metric.hpp"
#include "moclean/noise/noise.hpp"
#include "moclean/run/inputs.hpp"
#include "moclean/run/outputs.hpp"
#include "moclean/run/same_file.hpp"

#include "cli/commands/commands.hpp"
#include "cli/options/checks.hpp"
#include "cli/options/input_options.hpp"
#include "cli/printing/say.hpp"

namespace moclean::cli {
namespace {

struct CorruptOptions {
  std::filesystem::path input;
  std::filesystem::path output;
  std::filesystem::path mask;  // empty: not asked for
  std::string noise;
  std::uint64_t seed = 0;
  ReadOptions reading;
  bool force = false;
};

// 1 where the noise touched an entry, else 0.
Recording mask_of(const Corrupted& noisy) { return like(noisy.clip, noisy.touched.cast<double>()); }

ExitCode run(const CorruptOptions& options) {
  const NoiseChain noise = parse_noise_chain(options.noise);
  require_writable_recording(options.output);
  if (!options.mask.empty()) require_writable_recording(options.mask);
  for (const std::filesystem::path& output : {options.output, options.mask})
    if (!options.force) require_other_file(options.input, output);
  const NamedFile skeleton[] = {{"--skeleton", options.reading.skeleton}},
                  outputs[] = {{"-o", options.output}, {"--mask", options.mask}};
  require_apart(skeleton, outputs);
  for (const NamedFile& output : outputs) remove_left_beside(output.file);
  const Recording clean = read_recording(options.input, options.reading);
  const Corrupted noisy = corrupt(clean, noise, options.seed);
  AtomicFile clip = write_temporary(options.output, noisy.clip);
  std::optional<AtomicFile> mask;
  if (!options.mask.empty()) mask.emplace(write_temporary(options.mask, mask_of(noisy)));
  clip.commit();
  if (mask) mask->commit();
  const bool any_left = !(clean.samples - noisy.clip.samples).array().isNaN().all();
  say("{} -> {}: {} of {} entries changed, FD {}\n", options.input.string(),
      options.output.string(), noisy.touched.count(), noisy.touched.size(),
      any_left ? fmt::format("{:.6g}", frobenius_distance(clean.samples, noisy.clip.samples))
               : "of nothing left");
  return ExitCode::done;
}

}  // namespace

void add_corrupt(CLI::App& program, Action& action) {
  CLI::App& command = *program.add_subcommand("corrupt", "Add noise to a recording");
  command.footer(
      "Noise: NAME:key=value,key=value, several joined by +. docs/noise.md says what each does.\n"
      "  gaussian-frames:frames=COUNT,mean=M,sd=S  or fraction=SHARE (Peng et al., equation 7)\n"
      "  gaussian:sd=S                             or snr=DECIBEL\n"
      "  dropout:fraction=SHARE,fill=zero|nan,background=gaussian|none,snr=DECIBEL\n"
      "  burst:count=RUNS,length=FRAMES,sd=S       or fraction=SHARE\n"
      "  gap:count=RUNS,length=FRAMES              or fraction=SHARE\n"
      "  swap:count=RUNS,length=FRAMES             or fraction=SHARE\n"
      "  drift:count=RUNS,length=FRAMES,sd=S       or fraction=SHARE\n"
      "  ramp:count=RUNS,length=FRAMES,sd=S        or fraction=SHARE\n"
      "  limb-swap:count=RUNS,length=FRAMES        or fraction=SHARE; left and right\n"
      "  inertial-drift:sd=S,of=body|limb\n"
      "  jitter:sd=S,cutoff=HERTZ                  Gaussian, low-passed\n"
      "  white:sd-mm=S                             Gaussian, in millimetres; unit-mm= where "
      "needed\n"
      "  round:step=S                              to the nearest multiple\n"
      "The same seed gives the same noise everywhere.\n\n"
      "Example:\n"
      "  moclean corrupt walk.bvh -o noisy.csv --noise gaussian-frames:frames=400,mean=1,sd=1.2 "
      "--seed 1");
  const auto options = std::make_shared<CorruptOptions>();
  command.add_option("INPUT", options->input, with_extensions("Recording", can_read))
      ->required()
      ->type_name("");
  command.add_option("-o,--output", options->output, with_extensions("File", can_write))
      ->required()
      ->type_name("OUTPUT");
  command
      .add_option("--mask", options->mask,
                  with_extensions("Also write what the noise touched: 1 there, else 0", can_write))
      ->type_name("FILE");
  command.add_option("--noise", options->noise, "Noise model and its settings")
      ->required()
      ->type_name("SPEC");
  command.add_option("--seed", options->seed, "Seed of the random numbers")
      ->check(seed_number())
      ->capture_default_str()
      ->type_name("N");
  add_input_options(command, options->reading);
  command.add_flag("--force", options->force, "Results may replace INPUT");
  command.callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace moclean::cli
