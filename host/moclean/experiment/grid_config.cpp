#include "moclean/experiment/grid_config.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "moclean/core/usable.hpp"
#include "moclean/experiment/toml_section.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/frame_rate.hpp"
#include "moclean/formats/read_write.hpp"

namespace moclean {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t most_thinning = 1'000'000;

// The path with ${NAME} and ${NAME:-otherwise} replaced.
std::string expanded(const TomlSection& section, std::string_view key, std::string_view path,
                     const Environment& environment) {
  std::string result;
  for (std::size_t open; (open = path.find("${")) != path.npos;) {
    result += path.substr(0, open);
    path.remove_prefix(open + 2);
    const std::size_t close = path.find('}');
    if (close == path.npos) section.fail(key, "expected } after ${");
    const std::string_view whole = path.substr(0, close);
    const std::size_t otherwise = whole.find(":-");
    const std::string name(whole.substr(0, otherwise));
    const char* value = environment(name.c_str());
    if (value && *value != '\0')
      result += value;
    else if (otherwise != whole.npos)
      result += whole.substr(otherwise + 2);
    else
      section.fail(key, fmt::format("the environment variable {} is not set, and there is no "
                                    "${{{}:-otherwise}}",
                                    name, name));
    path.remove_prefix(close + 1);
  }
  return result.append(path);
}

fs::path path_of(const TomlSection& section, std::string_view key, const fs::path& config,
                 const Environment& environment) {
  const fs::path path = expanded(section, key, section.text(key), environment);
  return path.is_absolute() ? path : (config.parent_path() / path).lexically_normal();
}

GridTake take_of(const TomlSection& section, const fs::path& config,
                 const std::vector<std::string>& excluded, const Environment& environment) {
  section.allow(
      {"file", "label", "frames", "thin", "optional", "rate", "skeleton", "columns_exclude"});
  GridTake take{.file = path_of(section, "file", config, environment), .label = {}};
  take.label = section.text("label", take.file.stem().string());
  if (section.has("frames")) {
    const auto frames = parse_frame_span(section.text("frames"));
    if (!frames)
      section.fail("frames", fmt::format("expected \"A:B\" with A < B, found \"{}\"",
                                         section.text("frames")));
    take.frames = *frames;
  }
  take.thin = section.count("thin", most_thinning);
  take.optional = section.flag("optional");
  take.rate = section.number("rate", least_frame_rate, most_frame_rate);
  if (section.has("skeleton")) take.skeleton = path_of(section, "skeleton", config, environment);
  take.excluded = excluded;
  for (std::string& fragment : section.texts("columns_exclude"))
    take.excluded.push_back(std::move(fragment));
  take.line = section.line();
  return take;
}

// Calls parse() and gives its error a file and a line.
template <class Parse>
auto parsed(const TomlSection& section, const Parse& parse) {
  try {
    return parse(section.text("spec"));
  } catch (const ArgumentError& error) {
    section.fail("spec", error.what());
  }
}

ExperimentNoise noise_of(const TomlSection& section) {
  section.allow({"spec", "label"});
  return {section.text("label", section.text("spec")),
          parsed(section, [](const std::string& text) { return parse_noise_chain(text); })};
}

ExperimentMethod method_of(const TomlSection& section, const StepDefaults& defaults) {
  section.allow({"spec", "label"});
  return {section.text("label", section.text("spec")),
          parsed(section, [&](const std::string& text) {
            return text == "none" ? Chain{} : parse_chain(text, defaults);
          })};
}

template <class Axis>
void require_unlike_labels(const std::vector<TomlSection>& sections, const Axis& axis) {
  for (std::size_t i = 0; i < axis.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (axis[i].label == axis[j].label)
        sections[i].fail("label", fmt::format("'{}' is that of number {}, too; expected labels of "
                                              "their own",
                                              axis[i].label, j + 1));
}

GridConfig config_of(const fs::path& file, const toml::table& table, const StepDefaults& defaults,
                     const Environment& environment) {
  const TomlSection top(file, table, "");
  top.allow({"seeds", "columns_exclude", "take", "noise", "method"});
  GridConfig config{
      .file = file, .takes = {}, .noises = {}, .methods = {}, .seeds = top.seeds("seeds")};
  const std::vector<std::string> excluded = top.texts("columns_exclude");
  const auto takes = top.sections("take"), noises = top.sections("noise"),
             methods = top.sections("method");
  for (const TomlSection& section : takes)
    config.takes.push_back(take_of(section, file, excluded, environment));
  for (const TomlSection& section : noises) config.noises.push_back(noise_of(section));
  for (const TomlSection& section : methods) config.methods.push_back(method_of(section, defaults));
  require_unlike_labels(takes, config.takes);
  require_unlike_labels(noises, config.noises);
  require_unlike_labels(methods, config.methods);
  return config;
}

Recording selected(const Recording& clip, const FrameSpan& frames, const GridTake& take,
                   const fs::path& config) {
  const Index first = frames.first.value_or(0), last = frames.last.value_or(clip.frames());
  if (first >= last || last > clip.frames())
    throw FileError(config, take.line,
                    fmt::format("frames {}:{} do not fit {}, which has {} frames", first, last,
                                take.file.string(), clip.frames()));
  return excerpt(clip, first, last);
}

ExperimentTake read_take(const GridTake& take, const FrameSpan& frames, const fs::path& config) {
  const Recording all = read_recording(take.file, {.skeleton = take.skeleton, .rate = take.rate});
  const Recording part = selected(all, frames, take, config);
  if (const auto place = first_unusable(part.samples, false, std::numeric_limits<double>::max()))
    throw FileError(take.file, fmt::format("frame {}, column {} is {}; a truth needs every sample",
                                           frames.first.value_or(0) + place->frame,
                                           part.columns[static_cast<std::size_t>(place->column)],
                                           part.samples(place->frame, place->column)));
  const Recording thin = thinned(part, take.thin);
  return {.name = take.file.stem().string(),
          .label = take.label,
          .file = take.file,
          .clip = like(thin, thin.samples),
          .parents = joint_parents(thin),
          .excluded = take.excluded};
}

}  // namespace

std::optional<FrameSpan> parse_frame_span(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == text.npos) return std::nullopt;
  const auto parse = [](std::string_view part, std::optional<Index>& frame) {
    if (part.empty()) return true;
    Index value = 0;
    const auto [stop, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    frame = value;
    return error == std::errc{} && stop == part.data() + part.size() && value >= 0;
  };
  FrameSpan span;
  if (!parse(text.substr(0, colon), span.first) || !parse(text.substr(colon + 1), span.last))
    return std::nullopt;
  if (span.last && span.first.value_or(0) >= *span.last) return std::nullopt;
  return span;
}

GridConfig read_grid(const fs::path& file, const StepDefaults& defaults,
                     const Environment& environment) {
  const toml::table table = read_toml(file);
  const Environment own = [](const char* name) { return std::getenv(name); };
  return config_of(file, table, defaults, environment ? environment : own);
}

GridTakes read_takes(const GridConfig& config, const FrameSpan& frames) {
  GridTakes result;
  for (const GridTake& take : config.takes) {
    std::error_code error;
    if (take.optional && !fs::exists(take.file, error)) {
      result.missing.push_back(take.file);
      continue;
    }
    const bool own = take.frames != FrameSpan{};
    result.takes.push_back(read_take(take, own ? take.frames : frames, config.file));
  }
  if (result.takes.empty())
    throw FileError(config.file, "no take is left: every one is optional and not there");
  return result;
}

}  // namespace moclean
