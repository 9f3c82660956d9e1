#include <cstdint>
#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include "moclean/io/read_write.hpp"
#include "moclean/metric/metric.hpp"
#include "moclean/noise/noise.hpp"

#include "cli/commands.hpp"
#include "cli/inputs.hpp"
#include "cli/outputs.hpp"

namespace moclean::cli {
namespace {

struct CorruptOptions {
  std::filesystem::path input;
  std::filesystem::path output;
  std::string noise;
  std::uint64_t seed = 0;
  InputOptions reading;
};

ExitCode run(const CorruptOptions& options) {
  const Noise noise = parse_noise(options.noise);
  require_writable_clip(options.output);
  const Clip clean = read_input(options.input, options.reading);
  const Corrupted noisy = corrupt(clean, noise, options.seed);
  write_clip(options.output, noisy.clip);
  fmt::print("{} -> {}: {} of {} entries changed, FD {:.6g}\n", options.input.string(),
             options.output.string(), noisy.touched.count(), noisy.touched.size(),
             frobenius_distance(clean.samples, noisy.clip.samples));
  return ExitCode::done;
}

}  // namespace

void add_corrupt(CLI::App& program, Action& action) {
  CLI::App& command = *program.add_subcommand("corrupt", "Add noise to a recording");
  command.footer(
      "Noise: gaussian-frames:frames=COUNT,mean=M,sd=S takes COUNT frames at random (or\n"
      "fraction=SHARE of them) and adds a Gaussian to about half of the entries of each (Peng et\n"
      "al., equation 7). The same seed gives the same noise everywhere.\n\n"
      "Example:\n"
      "  moclean corrupt walk.bvh -o noisy.csv --noise gaussian-frames:frames=400,mean=1,sd=1.2 "
      "--seed 1");
  const auto options = std::make_shared<CorruptOptions>();
  command.add_option("INPUT", options->input, "Recording (.bvh .amc .csv .npy)")
      ->required()
      ->type_name("");
  command.add_option("-o,--output", options->output, "File (.csv .npy)")
      ->required()
      ->type_name("OUTPUT");
  command.add_option("--noise", options->noise, "Noise model and its settings")
      ->required()
      ->type_name("SPEC");
  command.add_option("--seed", options->seed, "Seed of the random numbers")
      ->capture_default_str()
      ->type_name("N");
  add_input_options(command, options->reading);
  command.callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace moclean::cli
