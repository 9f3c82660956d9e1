#include "cli/options/layers.hpp"

#include <algorithm>
#include <array>
#include <functional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "moclean/core/error.hpp"

#include "cli/nearest.hpp"

namespace moclean::cli {
namespace {

namespace fs = std::filesystem;

// A command as the program has it, for options from elsewhere.
struct FreshCommand {
  FreshCommand() { add_denoise_options(app, options); }
  FreshCommand(const FreshCommand&) = delete;
  FreshCommand& operator=(const FreshCommand&) = delete;

  // What CLI11 finds wrong becomes an ArgumentError; wants of an option that it `needs` another are
  // not for one line to fulfil.
  void parse(const std::vector<Setting>& settings, bool all) {
    std::vector<std::string> arguments, inputs;
    for (const Setting& setting : settings)
      for (const std::string& value : setting.values)
        if (setting.option == "input")
          inputs.push_back(value);
        else
          arguments.push_back(setting.is_flag ? "--" + setting.option
                                              : fmt::format("--{}={}", setting.option, value));
    arguments.emplace_back("--");  // names may begin like options
    arguments.insert(arguments.end(), inputs.begin(), inputs.end());
    std::ranges::reverse(arguments);  // as CLI11 takes them
    try {
      app.parse(arguments);
    } catch (const CLI::RequiresError& error) {
      if (all) throw ArgumentError(error.what());
    } catch (const CLI::ParseError& error) {
      throw ArgumentError(error.what());
    }
  }

  CLI::App app;
  DenoiseOptions options;
};

// The positional INPUT is `input` in a configuration.
const CLI::Option* option_named(const CLI::App& app, const std::string& name) {
  return app.get_option_no_throw(name == "input" ? "INPUT" : "--" + name);
}

std::vector<std::string> names_of(const CLI::App& app,
                                  const std::function<bool(const std::string&)>& wanted) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_lnames().empty() ? "input" : option->get_lnames().front();
    if (name != "help" && name != "config" && wanted(name)) names.push_back(name);
  }
  return names;
}

// What may differ from take to take.
bool is_of_a_take(const CLI::App& app, const std::string& name) {
  constexpr std::array others = {"frames",  "rate",    "skeleton", "layout",
                                 "columns", "missing", "format"};
  return std::ranges::find(others, name) != others.end() ||
         (name != "input" && option_named(app, name)->get_group() == method_group);
}

bool is_path(const std::string& name) {
  constexpr std::array paths = {"input",    "output", "outliers", "mask", "sigma",
                                "skeleton", "report", "truth",    "json", "lines"};
  return std::ranges::find(paths, name) != paths.end();
}

bool is_flag(const CLI::Option& option) { return option.get_items_expected_max() == 0; }

// Paths count from the folder of the configuration.
void resolve(const fs::path& file, Setting& setting) {
  if (!is_path(setting.option)) return;
  for (std::string& value : setting.values)
    if (value != "-" && fs::path(value).is_relative())
      value = (file.parent_path() / value).lexically_normal().string();
}

void require_known(const fs::path& file, const Setting& setting, bool of_folder) {
  const FreshCommand fresh;
  const auto names = names_of(fresh.app, [&](const std::string& name) {
    return !of_folder || is_of_a_take(fresh.app, name);
  });
  if (std::ranges::find(names, setting.option) != names.end()) return;
  const bool elsewhere = of_folder && option_named(fresh.app, setting.option);
  throw FileError(
      file, setting.line,
      elsewhere ? fmt::format("{} is for all takes and cannot be set for a folder", setting.option)
                : fmt::format("unknown key '{}', expected the name of an option of moclean denoise "
                              "without its dashes{}",
                              setting.option, did_you_mean(setting.option, names)));
}

void require_valid(const fs::path& file, const Setting& setting) {
  FreshCommand fresh;
  const CLI::Option& option = *option_named(fresh.app, setting.option);
  const auto fail = [&](const std::string& problem) {
    throw FileError(file, setting.line, problem);
  };
  if (is_flag(option) != setting.is_flag)
    fail(fmt::format("{}: expected {}", setting.option,
                     setting.is_flag ? "a value, found true or false" : "true or false"));
  const bool is_list = setting.option == "input" || setting.option == "missing";
  if (setting.values.size() > 1 && !is_list)
    fail(fmt::format("{}: expected one value, found a list", setting.option));
  try {
    fresh.parse({setting}, false);
    if (setting.option == "method") parse_chain(setting.values.front());
  } catch (const ArgumentError& error) {
    fail(error.what());
  }
}

// Leaves out of `below` what `above` sets, or what excludes it.
void lay(std::vector<Setting>& below, const std::vector<Setting>& above) {
  const FreshCommand fresh;
  const auto replaces = [&](const Setting& upper, const Setting& lower) {
    if (upper.option == lower.option) return true;
    if (upper.values.empty()) return false;
    const auto& excluded = option_named(fresh.app, upper.option)->get_excludes();
    return std::ranges::any_of(excluded, [&](const CLI::Option* option) {
      return option == option_named(fresh.app, lower.option);
    });
  };
  std::erase_if(below, [&](const Setting& lower) {
    return std::ranges::any_of(above, [&](const Setting& upper) { return replaces(upper, lower); });
  });
  below.insert(below.end(), above.begin(), above.end());
}

bool lies_below(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

}  // namespace

DenoiseLayers::DenoiseLayers(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    const bool positional = option->get_lnames().empty();
    given_.push_back({.option = positional ? "input" : option->get_lnames().front(),
                      .values = option->results(),
                      .is_flag = is_flag(*option)});
  }
}

void DenoiseLayers::add(const Configuration& configuration) {
  configuration_ = configuration;
  const auto check = [&](std::vector<Setting>& settings, bool of_folder) {
    for (Setting& setting : settings) {
      require_known(configuration_.file, setting, of_folder);
      resolve(configuration_.file, setting);
      require_valid(configuration_.file, setting);
    }
  };
  check(configuration_.settings, false);
  for (Configuration::Folder& folder : configuration_.folders) check(folder.settings, true);
}

std::vector<std::size_t> DenoiseLayers::folders_of(const fs::path& below) const {
  const auto depth = [&](std::size_t folder) {
    const fs::path& path = configuration_.folders[folder].path;
    return std::distance(path.begin(), path.end());
  };
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < configuration_.folders.size(); ++i)
    if (lies_below(below.parent_path(), configuration_.folders[i].path)) found.push_back(i);
  std::ranges::stable_sort(found, {}, depth);
  return found;
}

std::vector<std::string> DenoiseLayers::unused(const std::vector<fs::path>& takes_below) const {
  std::vector<std::string> lines;
  for (const Configuration::Folder& folder : configuration_.folders)
    if (std::ranges::none_of(takes_below, [&](const fs::path& below) {
          return lies_below(below.parent_path(), folder.path);
        }))
      lines.push_back(fmt::format("{}:{}: no take lies in the folder {}",
                                  configuration_.file.string(), folder.line, folder.path.string()));
  return lines;
}

DenoiseOptions DenoiseLayers::options(const std::vector<std::size_t>& folders) const {
  std::vector<Setting> settings = configuration_.settings;
  for (const std::size_t folder : folders) lay(settings, configuration_.folders[folder].settings);
  lay(settings, given_);
  FreshCommand fresh;
  fresh.parse(settings, true);
  complete(fresh.options);
  return fresh.options;
}

}  // namespace moclean::cli
