#pragma once

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

// Only grid_config.cpp includes this file: toml++ takes a while to compile.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "moclean/core/error.hpp"
#include "moclean/experiment/toml_file.hpp"

namespace moclean {

/// A table of a TOML file and how messages call it. Every member throws FileError naming file,
/// line, table, key and what was expected.
class TomlSection {
 public:
  TomlSection(const std::filesystem::path& file, const toml::table& table, std::string name)
      : file_(file), table_(table), name_(std::move(name)) {}

  std::size_t line() const { return table_.source().begin.line; }
  bool has(std::string_view key) const { return table_.contains(key); }

  [[noreturn]] void fail(std::string_view key, const std::string& problem) const {
    const toml::node* node = table_.get(key);
    throw FileError(file_, node ? node->source().begin.line : line(),
                    fmt::format("{}{}: {}", name_, key, problem));
  }

  /// Throws if a key is there that is not among `keys`.
  void allow(std::initializer_list<std::string_view> keys) const {
    for (const auto& [key, node] : table_)
      if (std::ranges::find(keys, key.str()) == keys.end())
        fail(key.str(), fmt::format("unknown key, expected one of {}", fmt::join(keys, ", ")));
  }

  /// A text that is not empty; it has to be there.
  std::string text(std::string_view key) const {
    const toml::node* node = table_.get(key);
    if (!node) fail(key, "missing, expected a text");
    const auto value = node->value_exact<std::string>();
    if (!value || value->empty()) fail(key, expected("a text", *node));
    return *value;
  }
  std::string text(std::string_view key, std::string otherwise) const {
    return has(key) ? text(key) : std::move(otherwise);
  }

  bool flag(std::string_view key) const {
    const toml::node* node = table_.get(key);
    if (!node) return false;
    const auto value = node->value_exact<bool>();
    if (!value) fail(key, expected("true or false", *node));
    return *value;
  }

  /// A number within bounds, or 0 if the key is absent.
  double number(std::string_view key, double least, double most) const {
    const toml::node* node = table_.get(key);
    if (!node) return 0;
    const auto value = node->value<double>();
    if (!value || !(*value >= least && *value <= most))
      fail(key, expected(fmt::format("a number from {} to {}", least, most), *node));
    return *value;
  }

  /// A whole number of 1 to `most`, or 1 if the key is absent.
  std::int64_t count(std::string_view key, std::int64_t most) const {
    const toml::node* node = table_.get(key);
    if (!node) return 1;
    const auto value = node->value_exact<std::int64_t>();
    if (!value || *value < 1 || *value > most)
      fail(key, expected(fmt::format("a whole number of 1 to {}", most), *node));
    return *value;
  }

  /// A list of texts; empty if the key is absent.
  std::vector<std::string> texts(std::string_view key) const {
    std::vector<std::string> found;
    const toml::node* node = table_.get(key);
    if (!node) return found;
    constexpr const char* wanted = "a list of texts";
    if (!node->is_array()) fail(key, expected(wanted, *node));
    for (const toml::node& element : *node->as_array()) {
      const auto value = element.value_exact<std::string>();
      if (!value || value->empty()) fail(key, expected(wanted, element));
      found.push_back(*value);
    }
    return found;
  }

  /// A whole number n of 1 to a million, which stands for 1 .. n, or a list of whole numbers >= 0.
  std::vector<std::uint64_t> seeds(std::string_view key) const {
    constexpr std::int64_t most = 1'000'000;
    const std::string wanted =
        fmt::format("how many (1 to {}) or a list of whole numbers from 0", most);
    const toml::node* node = table_.get(key);
    if (!node) fail(key, fmt::format("missing, expected {}", wanted));
    std::vector<std::uint64_t> found;
    if (const auto count = node->value_exact<std::int64_t>();
        count && *count >= 1 && *count <= most)
      for (std::int64_t seed = 1; seed <= *count; ++seed)
        found.push_back(static_cast<std::uint64_t>(seed));
    else if (node->is_array())
      for (const toml::node& element : *node->as_array()) {
        const auto seed = element.value_exact<std::int64_t>();
        if (!seed || *seed < 0) fail(key, expected(wanted, element));
        found.push_back(static_cast<std::uint64_t>(*seed));
      }
    if (found.empty()) fail(key, expected(wanted, *node));
    return found;
  }

  /// The tables of `[[key]]`; there has to be one.
  std::vector<TomlSection> sections(std::string_view key) const {
    const toml::node* node = table_.get(key);
    if (!node) fail(key, fmt::format("missing, expected at least one [[{}]]", key));
    std::vector<TomlSection> found;
    if (const toml::array* tables = node->as_array())
      for (const toml::node& element : *tables)
        if (element.is_table())
          found.emplace_back(file_, *element.as_table(),
                             fmt::format("{} {}: ", key, found.size() + 1));
    if (found.empty() || found.size() != node->as_array()->size())
      fail(key, fmt::format("expected tables, [[{}]]", key));
    return found;
  }

 private:
  static std::string expected(std::string_view what, const toml::node& node) {
    std::ostringstream text;
    node.visit([&](const auto& value) { text << value; });
    return fmt::format("expected {}, found {}", what, text.str());
  }

  const std::filesystem::path& file_;
  const toml::table& table_;
  std::string name_;
};

}  // namespace moclean
