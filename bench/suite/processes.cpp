// The sections whose measurements need processes of their own: PoCL fixes its number of threads and
// the place of its kernel cache at start, and the peak of the memory is one per process. This
// program starts itself with the argument `probe` and reads the JSON it prints.
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>
#include <sys/resource.h>

#include "moclean/backend/opencl_backend.hpp"
#include "moclean/core/error.hpp"
#include "moclean/noise/motion_like.hpp"

#include "suite/contestant.hpp"
#include "suite/sections.hpp"
#include "suite/statistics.hpp"
#include "suite/takes.hpp"

namespace moclean::bench {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// What this program prints when started as `ENVIRONMENT self probe ARGUMENTS`.
json run_probe(const Settings& settings, const std::string& environment,
               const std::string& arguments) {
  const std::string command =
      fmt::format("env {} '{}' probe {}", environment, settings.self.string(), arguments);
  const auto close = [](std::FILE* pipe) { pclose(pipe); };
  const std::unique_ptr<std::FILE, decltype(close)> pipe(popen(command.c_str(), "r"), close);
  if (!pipe) throw Error("cannot start " + command);
  std::string output;
  for (int c = std::fgetc(pipe.get()); c != EOF; c = std::fgetc(pipe.get()))
    output += static_cast<char>(c);
  const json result = json::parse(output, nullptr, false);
  if (result.is_discarded()) throw Error(command + " failed");
  return result;
}

/// A folder that is gone when the object is.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = fs::temp_directory_path() / "moclean-bench-XXXXXX";
    if (!mkdtemp(name.data()))
      throw Error("cannot make a folder in " + fs::temp_directory_path().string());
    path_ = name;
  }
  ~TemporaryFolder() { fs::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

json probe_threads(int threads, const fs::path& data) {
  const Device device(device_selection());
  const Workload workload = cut_into_segments(noisy_takes(data).front(), 200);
  std::vector<Contestant> contestants;
  contestants.push_back(opencl(device));
  contestants.push_back(lapack(threads));
  contestants.push_back(eigen(threads));
  json seconds;
  for (const Contestant& contestant : contestants) {
    contestant.backend->solve(workload.data, contestant.method);
    seconds[contestant.name] =
        seconds_of([&] { contestant.backend->solve(workload.data, contestant.method); });
  }
  return seconds;
}

json probe_start_up() {
  const SegmentBatch data = motion_like(4, 200, 93);
  std::unique_ptr<Device> device;
  std::unique_ptr<OpenClBackend> backend;
  json seconds;
  seconds["device"] = seconds_of([&] { device = std::make_unique<Device>(device_selection()); });
  seconds["kernels"] = seconds_of([&] {
    backend = std::make_unique<OpenClBackend>(*device);
    backend->prepare(RobustPca{});
  });
  seconds["first_solve"] = seconds_of([&] { backend->solve(data, RobustPca{}); });
  seconds["second_solve"] = seconds_of([&] { backend->solve(data, RobustPca{}); });
  return seconds;
}

long peak_kilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

json probe_memory(Index segments, std::uint64_t limit) {
  const Device device(device_selection());
  OpenClBackend backend(device, OpenClOptions{.memory_limit = limit});
  backend.solve(motion_like(1, 200, 93), RobustPca{});
  const SegmentBatch data = motion_like(segments, 200, 93);
  const long before = peak_kilobytes();
  const Solution solution = backend.solve(data, RobustPca{});
  const auto caller = 2 * solution.low_rank.storage().size_bytes();  // A and E, the caller's
  return {{"segments", segments},
          {"limit_bytes", limit},
          {"data_and_solution_bytes", caller + data.storage().size_bytes()},
          {"solver_bytes", std::max(0.0, 1024.0 * static_cast<double>(peak_kilobytes() - before) -
                                             static_cast<double>(caller))}};
}

}  // namespace

json probe(const std::vector<std::string>& arguments) {
  const auto is = [&](const char* name, std::size_t count) {
    return arguments.size() == count && arguments[0] == name;
  };
  if (is("threads", 3)) return probe_threads(std::stoi(arguments[1]), arguments[2]);
  if (is("start_up", 1)) return probe_start_up();
  if (is("memory", 3)) return probe_memory(std::stoi(arguments[1]), std::stoull(arguments[2]));
  throw ArgumentError(fmt::format("probe {}: no such measurement", fmt::join(arguments, " ")));
}

json measure_threads(const Settings& settings, const Device&) {
  std::map<int, std::map<std::string, std::vector<double>>> seconds;
  for (int repetition = 0; repetition < settings.repetitions; ++repetition)
    for (const int threads : {1, 2}) {
      const json once = run_probe(settings, fmt::format("POCL_MAX_PTHREAD_COUNT={}", threads),
                                  fmt::format("threads {} '{}'", threads, settings.data.string()));
      for (const auto& [name, value] : once.items()) seconds[threads][name].push_back(value);
    }
  json record;
  for (const auto& [name, values] : seconds[1]) {
    std::vector<double> speed_up;
    for (std::size_t i = 0; i < values.size(); ++i)
      speed_up.push_back(values[i] / seconds[2][name][i]);
    record.push_back({{"name", name},
                      {"one", summary(values)},
                      {"two", summary(seconds[2][name])},
                      {"speed_up", summary(speed_up)}});
  }
  return record;
}

json measure_start_up(const Settings& settings, const Device&) {
  const char* steps[] = {"device", "kernels", "first_solve", "second_solve"};
  std::map<std::string, std::map<std::string, std::vector<double>>> seconds;
  for (int repetition = 0; repetition < settings.repetitions; ++repetition) {
    const TemporaryFolder cache;
    for (const char* state : {"cold", "warm"}) {
      const json once = run_probe(
          settings, fmt::format("POCL_CACHE_DIR='{}'", cache.path().string()), "start_up");
      for (const char* step : steps) seconds[state][step].push_back(once.at(step));
    }
  }
  json record;
  for (const auto& [state, by_step] : seconds)
    for (const char* step : steps) record[state][step] = summary(by_step.at(step));
  return record;
}

json measure_memory(const Settings& settings, const Device&) {
  constexpr std::uint64_t mebibyte = 1 << 20;
  const std::vector<Index> counts =
      settings.quick ? std::vector<Index>{16, 32, 64} : std::vector<Index>{16, 32, 64, 256, 1024};
  json record;
  for (const std::uint64_t limit : {std::uint64_t{0}, 64 * mebibyte})
    for (const Index segments : counts)
      record.push_back(run_probe(settings, "", fmt::format("memory {} {}", segments, limit)));
  return record;
}

}  // namespace moclean::bench
