#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "moclean/formats/formats.hpp"
#include "moclean/run/inputs.hpp"
#include "moclean/run/run_report.hpp"

#include "cli/commands/commands.hpp"
#include "cli/options/input_options.hpp"
#include "cli/printing/json_record.hpp"
#include "cli/printing/say.hpp"

namespace moclean::cli {
namespace {

struct InfoOptions {
  std::filesystem::path file;
  ReadOptions reading;
  bool json = false;
};

// The extension without its dot, of a file that could be read.
std::string format_name(const std::filesystem::path& file) {
  return std::string(format_of(file)->extension.substr(1));
}

// What the file does not state is null.
Json info_record(const std::filesystem::path& file, const Recording& clip) {
  const bool has_rate = clip.frame_rate > 0;
  Json record;
  record["file"] = file.string();
  record["format"] = format_name(file);
  record["frames"] = clip.frames();
  record["columns"] = clip.samples.cols();
  record["joints"] = Json::array();
  for (const Joint& joint : joints(clip)) record["joints"].push_back(joint.name);
  record["rate"] = has_rate ? Json(clip.frame_rate) : Json(nullptr);
  record["unit"] = clip.unit.empty() ? Json(nullptr) : Json(clip.unit);
  record["duration"] =
      has_rate ? Json(static_cast<double>(clip.frames()) / clip.frame_rate) : Json(nullptr);
  record["missing"] = clip.samples.array().isNaN().count();
  record["layout"] = clip.notes.layout.empty() ? Json(nullptr) : Json(clip.notes.layout);
  record["passed_through"] = clip.notes.passed_through;
  record["warnings"] = clip.notes.warnings;
  return record;
}

void print_info(const std::filesystem::path& file, const Recording& clip) {
  say("format    {}\n", format_name(file));
  say("frames    {}\n", clip.frames());
  say("columns   {}\n", clip.samples.cols());
  std::string names;
  const std::vector<Joint> all = joints(clip);
  for (const Joint& joint : all) names += (names.empty() ? "" : " ") + joint.name;
  say("joints    {}: {}\n", all.size(), names);
  if (clip.frame_rate > 0) {
    say("rate      {:.6g} Hz\n", clip.frame_rate);
    say("duration  {:.6g} s\n", static_cast<double>(clip.frames()) / clip.frame_rate);
  } else {
    say("rate      unknown (--rate states it)\n");
  }
  say("unit      {}\n", clip.unit.empty() ? "unknown" : clip.unit);
  say("missing   {} samples\n", clip.samples.array().isNaN().count());
  if (!clip.notes.layout.empty()) say("layout    {}\n", clip.notes.layout);
  for (const std::string& line : note_lines(file, clip.notes)) warn("{}", line);
}

ExitCode run(const InfoOptions& options) {
  const Recording clip = read_recording(options.file, options.reading);
  if (options.json)
    write_output(to_text(info_record(options.file, clip)));
  else
    print_info(options.file, clip);
  return ExitCode::done;
}

}  // namespace

void add_info(CLI::App& program, Action& action) {
  CLI::App& command = *program.add_subcommand("info", "Say what a recording holds");
  command.footer("Example:\n  moclean info walk.bvh");
  const auto options = std::make_shared<InfoOptions>();
  command.add_option("FILE", options->file, with_extensions("Recording", can_read))
      ->required()
      ->type_name("");
  add_input_options(command, options->reading);
  command.add_flag("--json", options->json, "Print the facts as JSON");
  command.callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace moclean::cli
