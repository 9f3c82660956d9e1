#include "moclean/experiment/results.hpp"

#include <limits>
#include <optional>

#include <nlohmann/json.hpp>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

using Json = nlohmann::ordered_json;

Json record(const std::string& key, const CellResult& result) {
  Json json = {{"key", key}, {"frames", result.frames}, {"unconverged", result.unconverged}};
  json["figures"] = Json::object();
  for (const auto& [name, value] : result.figures) json["figures"][name] = value;  // NaN: null
  if (!result.refused.empty()) json["refused"] = result.refused;
  return json;
}

bool is_result(const Json& json) {
  const auto has = [&](const char* name, bool (Json::*is)() const) {
    return json.contains(name) && (json[name].*is)();
  };
  if (!json.is_object() || !has("key", &Json::is_string) ||
      !has("frames", &Json::is_number_integer) || !has("unconverged", &Json::is_number_integer) ||
      !has("figures", &Json::is_object))
    return false;
  if (json.contains("refused") && !json["refused"].is_string()) return false;
  for (const auto& [name, value] : json["figures"].items())
    if (!value.is_number() && !value.is_null()) return false;
  return true;
}

CellResult result_of(const Json& json) {
  CellResult result{.frames = json["frames"].get<Index>(),
                    .unconverged = json["unconverged"].get<Index>()};
  for (const auto& [name, value] : json["figures"].items())
    result.figures[name] =
        value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
  if (json.contains("refused")) result.refused = json["refused"].get<std::string>();
  return result;
}

}  // namespace

CellResults::CellResults(const std::filesystem::path& file) : log_(file) {
  std::size_t line = 0;
  for (const std::string& text : log_.found()) {
    ++line;
    const Json json = Json::parse(text, nullptr, false);
    if (json.is_discarded() || !is_result(json))
      throw FileError(file, line,
                      "expected the result of a cell as JSON; remove the file to begin anew");
    results_[json["key"].get<std::string>()] = result_of(json);
  }
}

const CellResult* CellResults::find(const std::string& key) const {
  const auto found = results_.find(key);
  return found == results_.end() ? nullptr : &found->second;
}

void CellResults::keep(const std::string& key, const CellResult& result) {
  log_.append(record(key, result).dump(-1, ' ', false, Json::error_handler_t::replace));
  results_[key] = result;
}

}  // namespace moclean
