#include "cli/backend/tuning_cache.hpp"

#include <cstdlib>
#include <limits>

#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/core/hash.hpp"
#include "moclean/formats/file.hpp"

#include "cli/options/backend_options.hpp"

namespace moclean::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* format_name = "moclean tuning";
constexpr int format_version = 1;

fs::path cache_folder() {
  const char* const xdg = std::getenv("XDG_CACHE_HOME");
  if (xdg && fs::path(xdg).is_absolute()) return fs::path(xdg) / "moclean";
  const char* const home = std::getenv("HOME");
  return home && *home ? fs::path(home) / ".cache" / "moclean" : fs::path();
}

// Letters and digits of a device's name, for people who look into the folder.
std::string readable(std::string_view name) {
  std::string result;
  for (const char c : name.substr(0, 40)) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    result += plain ? c : '-';
  }
  return result;
}

// Whose tuning it is.
Json identity(const DeviceInfo& device) {
  return {{"device", device.name}, {"platform", device.platform_name}, {"driver", device.driver}};
}

int choice(const Json& record, const char* name) {
  const Json& number = record.at(name);
  if (!number.is_number_integer())  // one beyond std::int64_t may not be converted
    throw ArgumentError(fmt::format("tuning: {} is {}, not a whole number", name, number.dump()));
  const auto value = number.get<std::int64_t>();
  if (value < 0 || value > std::numeric_limits<std::int32_t>::max())
    throw ArgumentError(fmt::format("tuning: {} is {}", name, value));
  return static_cast<int>(value);
}

// Form and products. In a file from before forms had a name the products told both.
void read_form(const Json& record, Tuning& tuning) {
  const auto products = record.at("products").get<std::string>();
  if (record.contains("form")) {
    tuning.form = parse_kernel_form(record.at("form").get<std::string>());
    tuning.products = parse_product_path(products);
  } else if (products == former_gpu_products) {
    tuning.form = KernelForm::gpu;
  } else {
    tuning.products = parse_product_path(products);
  }
}

// Files from before form had a name say `lanes` and `group`.
KernelForm eigen_form(const std::string& text) {
  if (text == "lanes") return KernelForm::cpu;
  if (text == "group") return KernelForm::gpu;
  return parse_kernel_form(text);
}

// A file from before there were queues, or products in work-groups, leaves them at their default.
Tuning tuning_of(const Json& record, const DeviceInfo& device) {
  Tuning tuning{.tile_rows = choice(record, "tile_rows"),
                .tile_vectors = choice(record, "tile_vectors"),
                .sweep_rows = choice(record, "sweep_rows"),
                .panel = choice(record, "panel"),
                .work_group = record.contains("work_group") ? choice(record, "work_group")
                                                            : default_tuning(device).work_group,
                .eigen = eigen_form(record.at("eigen").get<std::string>()),
                .batch_segments = choice(record, "batch_segments"),
                .queues = record.contains("queues") ? choice(record, "queues")
                                                    : default_tuning(device).queues};
  read_form(record, tuning);
  check(tuning);
  return tuning;
}

Tuning parse(const std::string& text, const DeviceInfo& device) {
  const Json record = Json::parse(text);
  if (record.at("format") != format_name || record.at("version") != format_version)
    throw Error(fmt::format("not a {} of version {}", format_name, format_version));
  const Json wanted = identity(device);
  for (const auto& [name, expected] : wanted.items())
    if (record.at(name) != expected)
      throw Error(
          fmt::format("made for {} {}, not {}", name, record.at(name).dump(), expected.dump()));
  return tuning_of(record.at("tuning"), device);
}

}  // namespace

fs::path tuning_file(const DeviceInfo& device) {
  const fs::path folder = cache_folder();
  if (folder.empty()) return {};
  const std::uint64_t hash =
      Fnv1a().bytes(identity(device).dump(-1, ' ', false, Json::error_handler_t::replace)).value();
  return folder / fmt::format("tuning-{}-{:016x}.json", readable(device.name), hash);
}

CachedTuning read_tuning(const fs::path& file, const DeviceInfo& device) {
  std::error_code ignored;
  if (file.empty() || !fs::exists(file, ignored)) return {};
  try {
    return {.tuning = parse(read_file(file), device), .problem = {}};
  } catch (const std::exception& error) {  // of JSON's, the file's or ours
    return {.tuning = {}, .problem = fmt::format("{}: {}", file.string(), error.what())};
  }
}

void write_tuning(const fs::path& file, const DeviceInfo& device, const Tuning& tuning) {
  std::error_code failure;
  fs::create_directories(file.parent_path(), failure);
  if (failure) throw FileError(file.parent_path(), "cannot be made: " + failure.message());
  Json record{{"format", format_name}, {"version", format_version}};
  record.update(identity(device));
  record["tuning"] = tuning_record(tuning);
  AtomicFile target(file);
  target.write(to_text(record));
  target.commit();
}

Json tuning_record(const Tuning& tuning) {
  return {{"tile_rows", tuning.tile_rows},           {"tile_vectors", tuning.tile_vectors},
          {"sweep_rows", tuning.sweep_rows},         {"panel", tuning.panel},
          {"form", to_string(tuning.form)},          {"products", to_string(tuning.products)},
          {"work_group", tuning.work_group},         {"eigen", to_string(tuning.eigen)},
          {"batch_segments", tuning.batch_segments}, {"queues", tuning.queues}};
}

}  // namespace moclean::cli
