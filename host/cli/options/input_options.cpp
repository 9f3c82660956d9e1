#include "cli/options/input_options.hpp"

#include <charconv>
#include <map>
#include <optional>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/formats/frame_rate.hpp"

#include "cli/options/checks.hpp"

namespace moclean::cli {
namespace {

std::optional<Index> parse_frame(std::string_view text, const std::string& problem) {
  if (text.empty()) return std::nullopt;
  Index frame = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), frame);
  if (error == std::errc::result_out_of_range && stop == text.data() + text.size())
    throw ArgumentError(fmt::format("{}; {} is too large", problem, text));
  if (error != std::errc{} || stop != text.data() + text.size() || frame < 0)
    throw ArgumentError(problem);
  return frame;
}

}  // namespace

std::string with_extensions(const std::string& text, FormatTrait trait) {
  return fmt::format("{} ({})", text, listed_extensions(trait));
}

FrameRange parse_frame_range(const std::string& text, const std::string& option) {
  const std::string_view view = text;
  const std::size_t colon = view.find(':');
  const std::string problem = fmt::format(
      "{} is '{}', expected A:B with whole numbers from 0, for instance 0:2800", option, text);
  if (colon == view.npos) throw ArgumentError(problem);
  const FrameRange range{parse_frame(view.substr(0, colon), problem),
                         parse_frame(view.substr(colon + 1), problem)};
  if (range.last && range.first.value_or(0) >= *range.last)
    throw ArgumentError(fmt::format("{} {} holds no frame: A:B means A up to B - 1", option, text));
  return range;
}

void add_frames_option(CLI::App& command, FrameRange& frames, const std::string& help) {
  command
      .add_option_function<std::string>(
          "--frames", [&](const std::string& text) { frames = parse_frame_range(text); }, help)
      ->type_name("A:B");
}

void add_file_options(CLI::App& command, double& rate, std::filesystem::path& skeleton) {
  command.add_option("--rate", rate, "Frame rate of files that state none")
      ->type_name("HZ")
      ->check(number_between(least_frame_rate, most_frame_rate));
  command
      .add_option("--skeleton", skeleton,
                  "Skeleton of .amc files; otherwise the .asf beside them that fits their name")
      ->type_name("FILE.asf");
}

void add_column_options(CLI::App& command, ReadOptions& options) {
  const std::map<std::string, ColumnLayout> layouts = {{"points3", ColumnLayout::points3},
                                                       {"points2", ColumnLayout::points2},
                                                       {"plain", ColumnLayout::plain}};
  auto* layout =
      command
          .add_option_function<std::string>(
              "--layout",
              [&options, layouts](const std::string& name) { options.layout = layouts.at(name); },
              "What the columns of tables and arrays are, whatever their names: points "
              "of three coordinates, of two, or plain channels")
          ->check(one_of({"points3", "points2", "plain"}))
          ->type_name("LAYOUT");
  command
      .add_option("--columns", options.columns,
                  "What every single column is, from left to right (docs/formats.md): t,(xyz)*")
      ->excludes(layout)
      ->type_name("SPEC");
  command
      .add_option(
          "--missing", options.missing,
          "A number that stands for a missing sample; may be given again. 0 is one where all "
          "coordinates of a point are 0")
      ->check(number())
      ->type_size(1)
      ->allow_extra_args(false)
      ->type_name("VALUE");
}

void add_input_options(CLI::App& command, ReadOptions& options) {
  add_frames_option(command, options.frames,
                    "Use frames A up to B - 1 only, counted from 0; A or B may be left out");
  add_file_options(command, options.rate, options.skeleton);
  add_column_options(command, options);
}

}  // namespace moclean::cli
