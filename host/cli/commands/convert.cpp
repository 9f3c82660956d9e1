#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "moclean/formats/read_write.hpp"
#include "moclean/run/inputs.hpp"
#include "moclean/run/outputs.hpp"

#include "cli/commands/commands.hpp"
#include "cli/options/input_options.hpp"

namespace moclean::cli {
namespace {

struct ConvertOptions {
  std::filesystem::path input;
  std::filesystem::path output;
  InputOptions reading;
};

ExitCode run(const ConvertOptions& options) {
  require_writable_clip(options.output);
  const Clip clip = read_input(options.input, options.reading);
  write_clip(options.output, clip);
  fmt::print("{} -> {}: {} frames x {} columns\n", options.input.string(), options.output.string(),
             clip.frames(), clip.samples.cols());
  return ExitCode::done;
}

}  // namespace

void add_convert(CLI::App& program, Action& action) {
  CLI::App& command =
      *program.add_subcommand("convert", "Rewrite a recording; skeletons become joint positions");
  command.footer("Example:\n  moclean convert 14_06.amc 14_06.npy --skeleton 14.asf");
  const auto options = std::make_shared<ConvertOptions>();
  command.add_option("INPUT", options->input, "Recording (.bvh .amc .csv .npy)")
      ->required()
      ->type_name("");
  command.add_option("OUTPUT", options->output, "File (.csv .npy)")->required()->type_name("");
  add_input_options(command, options->reading);
  command.callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace moclean::cli
