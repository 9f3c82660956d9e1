// Measures moclean against its peers and writes one JSON record. bench/run builds and starts it.

#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <thread>

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <fmt/format.h>
#include <sys/utsname.h>

#include "moclean/core/error.hpp"

#include "peers/segment_solver.hpp"
#include "suite/sections.hpp"
#include "suite/statistics.hpp"

namespace moclean::bench {
namespace {

using nlohmann::json;

/// The first `model name` of /proc/cpuinfo.
std::string processor() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

json machine(const Device& device) {
  utsname system{};
  uname(&system);
  const DeviceInfo& info = device.info();
  return {{"processor", processor()},
          {"cores", std::thread::hardware_concurrency()},
          {"system", std::string(system.sysname) + " " + system.release},
          {"compiler", "GCC " __VERSION__},
          {"device", info.name},
          {"platform", info.platform_name},
          {"driver", info.driver},
          {"vector_width", info.vector_width},
          {"openblas", peers::openblas_description()},
          {"openblas_kernels", peers::openblas_kernels()},
          {"eigen",
           fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"revision", MOCLEAN_REVISION}};
}

void measure(const Settings& settings, const std::vector<std::string>& wanted,
             const std::string& output) {
  const Device device(device_selection());
  json record = {{"machine", machine(device)},
                 {"repetitions", settings.repetitions},
                 {"threads", settings.threads},
                 {"quick", settings.quick}};
  for (const Section& section : sections()) {
    if (!wanted.empty() && std::ranges::find(wanted, section.name) == wanted.end()) continue;
    std::cerr << "bench: " << section.name << std::flush;
    const double seconds =
        seconds_of([&] { record["sections"][section.name] = section.measure(settings, device); });
    std::cerr << ", " << static_cast<int>(seconds + 0.5) << " s\n";
    std::ofstream(output) << record.dump(1) << '\n';  // so that a later failure leaves the earlier
  }
}

int run(int argc, char** argv) {
  CLI::App app("Measures moclean against LAPACK and Eigen and writes a JSON record", "bench/run");
  Settings settings;
  settings.self = std::filesystem::canonical("/proc/self/exe");
  settings.threads = static_cast<int>(std::thread::hardware_concurrency());
  std::string output = "bench.json";
  std::vector<std::string> names, wanted, probed;
  for (const Section& section : sections()) names.push_back(section.name);
  app.add_option("--json", output, "the record")->capture_default_str();
  app.add_option("--data", settings.data, "collection of takes with cmu/14/14_06.amc")
      ->envname("MOCLEAN_DATA");
  app.add_option("--repetitions", settings.repetitions, "times every contestant is timed")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--only", wanted, "these sections, not all")->check(CLI::IsMember(names));
  app.add_flag("--quick", settings.quick, "fewer points on every axis");
  CLI::App* child = app.add_subcommand("probe")->group("");  // for this program's own use
  child->add_option("arguments", probed);
  CLI11_PARSE(app, argc, argv);

  if (*child) {
    std::cout << probe(probed) << '\n';
  } else {
    measure(settings, wanted, output);
  }
  return 0;
}

}  // namespace
}  // namespace moclean::bench

int main(int argc, char** argv) {
  try {
    return moclean::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "\nbench: " << error.what() << '\n';
    return 1;
  }
}
