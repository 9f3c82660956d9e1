#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "moclean/core/error.hpp"
#include "moclean/device/device.hpp"

#include "cli/backend/driver_check.hpp"
#include "cli/commands/commands.hpp"
#include "cli/printing/json_record.hpp"
#include "cli/printing/say.hpp"

namespace moclean::cli {
namespace {

Json device_record(const DeviceInfo& info) {
  Json record;
  record["platform"] = info.platform;
  record["index"] = info.index;
  record["name"] = info.name;
  record["platform_name"] = info.platform_name;
  record["driver"] = info.driver;
  record["version"] = info.version;
  record["kind"] = to_string(info.kind);
  record["fp64"] = info.fp64;
  record["compute_units"] = info.compute_units;
  record["vector_width"] = info.vector_width;
  record["global_memory"] = info.global_memory;
  record["max_allocation"] = info.max_allocation;
  record["local_memory"] = info.local_memory;
  record["max_work_group"] = info.max_work_group;
  return record;
}

ExitCode run(bool json) {
  require_driver();
  const std::vector<DeviceInfo> devices = list_devices();
  if (json) {
    Json records = Json::array();
    for (const DeviceInfo& device : devices) records.push_back(device_record(device));
    write_output(to_text(records));
    return ExitCode::done;
  }
  if (devices.empty())
    throw DeviceError("no OpenCL device found; install a driver, for a CPU pocl-opencl-icd");
  for (const DeviceInfo& device : devices) say("{}\n", describe(device));
  return ExitCode::done;
}

}  // namespace

void add_devices(CLI::App& program, Action& action) {
  CLI::App& command = *program.add_subcommand("devices", "List the OpenCL devices");
  command.footer(
      "Example:\n  moclean devices\n  moclean denoise walk.bvh -o clean.npy --device 0:0");
  const auto json = std::make_shared<bool>(false);
  command.add_flag("--json", *json, "Print everything the devices say about themselves as JSON");
  command.callback([&action, json] { action = [json] { return run(*json); }; });
}

}  // namespace moclean::cli
