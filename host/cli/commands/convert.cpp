#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/formats.hpp"
#include "moclean/formats/losses.hpp"
#include "moclean/formats/read_write.hpp"
#include "moclean/formats/temporary_name.hpp"
#include "moclean/run/inputs.hpp"
#include "moclean/run/outputs.hpp"
#include "moclean/run/run_report.hpp"
#include "moclean/run/same_file.hpp"

#include "cli/commands/commands.hpp"
#include "cli/options/input_options.hpp"
#include "cli/printing/say.hpp"

namespace moclean::cli {
namespace {

struct ConvertOptions {
  std::filesystem::path input;
  std::filesystem::path output;
  ReadOptions reading;
  bool strict = false;
  bool force = false;
};

ExitCode run(const ConvertOptions& options) {
  require_writable_recording(options.output);
  if (!options.force) require_other_file(options.input, options.output);
  const NamedFile skeleton[] = {{"--skeleton", options.reading.skeleton}},
                  output[] = {{"OUTPUT", options.output}};
  require_apart(skeleton, output);
  remove_left_beside(options.output);
  const Recording clip = read_recording(options.input, options.reading);
  const std::vector<std::string> lost =
      losses(clip, *format_of(options.input), *format_of(options.output));
  if (options.strict && !lost.empty())
    throw FileError(options.output, fmt::format("cannot be written: {}", fmt::join(lost, "; ")));
  for (const std::string& loss : lost) warn("{}: {}", options.output.string(), loss);
  write_recording(options.output, clip);
  for (const std::string& line : note_lines(options.input, clip.notes)) warn("{}", line);
  say("{} -> {}: {} frames x {} columns\n", options.input.string(), options.output.string(),
      clip.frames(), clip.samples.cols());
  return ExitCode::done;
}

// A line per format: extension, what is done with it, what to know.
std::string format_notes() {
  std::string text;
  for (const Format* format : formats()) {
    std::string notes(format->notes);
    std::erase(notes, '`');
    text += fmt::format("  {:<6}{:<13}{}\n", format->extension,
                        can_write(*format) ? "read, write" : "read", notes);
  }
  return text;
}

}  // namespace

void add_convert(CLI::App& program, Action& action) {
  CLI::App& command =
      *program.add_subcommand("convert", "Rewrite a recording; skeletons become joint positions");
  command.footer("Formats:\n" + format_notes() +
                 "\nExample:\n  moclean convert 14_06.amc 14_06.npy --skeleton 14.asf");
  const auto options = std::make_shared<ConvertOptions>();
  command.add_option("INPUT", options->input, with_extensions("Recording", can_read))
      ->required()
      ->type_name("");
  command.add_option("OUTPUT", options->output, with_extensions("File", can_write))
      ->required()
      ->type_name("");
  add_input_options(command, options->reading);
  command.add_flag("--force", options->force, "OUTPUT may be INPUT");
  command.add_flag("--strict", options->strict,
                   "Fail, and write nothing, if the format of OUTPUT cannot hold all of INPUT");
  command.callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace moclean::cli
