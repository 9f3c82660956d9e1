#include "cli/options/config_file.hpp"

#include <sstream>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/experiment/toml_file.hpp"

namespace moclean::cli {
namespace {

namespace fs = std::filesystem;

std::size_t line_of(const toml::node& node) { return node.source().begin.line; }

[[noreturn]] void fail_at(const fs::path& file, const toml::node& node, std::string_view key,
                          const char* expected) {
  std::ostringstream found;
  node.visit([&](const auto& value) { found << value; });
  throw FileError(file, line_of(node),
                  fmt::format("{}: expected {}, found {}", key, expected, found.str()));
}

// As on a command line.
std::string text_of(const fs::path& file, std::string_view key, const toml::node& node) {
  if (const auto text = node.value_exact<std::string>()) return *text;
  if (const auto whole = node.value_exact<std::int64_t>()) return fmt::format("{}", *whole);
  if (const auto number = node.value_exact<double>()) return fmt::format("{}", *number);
  fail_at(file, node, key, "a text or a number");
}

Setting setting_of(const fs::path& file, std::string_view key, const toml::node& node) {
  Setting setting{.option = std::string(key), .values = {}, .line = line_of(node)};
  if (const auto flag = node.value_exact<bool>()) {
    setting.is_flag = true;
    if (*flag) setting.values = {"true"};
  } else if (const toml::array* list = node.as_array()) {
    for (const toml::node& element : *list) setting.values.push_back(text_of(file, key, element));
    if (list->empty()) fail_at(file, node, key, "at least one value");
  } else {
    setting.values = {text_of(file, key, node)};
  }
  return setting;
}

Configuration::Folder folder_of(const fs::path& file, const toml::table& table) {
  Configuration::Folder folder{.path = {}, .settings = {}, .line = line_of(table)};
  for (const auto& [key, node] : table) {
    if (key.str() != "path")
      folder.settings.push_back(setting_of(file, key.str(), node));
    else if (const auto path = node.value_exact<std::string>(); path && !path->empty())
      folder.path = (fs::path(*path) / "").lexically_normal().parent_path();
    else
      fail_at(file, node, "path", "a folder");
  }
  if (folder.path.empty())
    throw FileError(file, folder.line, "[[folder]]: expected path = \"FOLDER\"");
  if (folder.path.is_absolute())
    fail_at(file, *table.get("path"), "path", "a path below the folder of takes");
  return folder;
}

}  // namespace

Configuration read_configuration(const fs::path& file) {
  const toml::table table = read_toml(file);
  Configuration configuration{.file = file, .settings = {}, .folders = {}};
  for (const auto& [key, node] : table) {
    if (key.str() != "folder") {
      configuration.settings.push_back(setting_of(file, key.str(), node));
      continue;
    }
    const toml::array* tables = node.as_array();
    if (!tables) fail_at(file, node, "folder", "tables, [[folder]]");
    for (const toml::node& element : *tables) {
      if (!element.is_table()) fail_at(file, element, "folder", "tables, [[folder]]");
      configuration.folders.push_back(folder_of(file, *element.as_table()));
    }
  }
  return configuration;
}

}  // namespace moclean::cli
