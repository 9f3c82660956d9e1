// Reading and writing of recordings, one thread (rates per second of its CPU), on real takes: the
// CMU collection where it is
// ($MOCLEAN_DATA, else shared/data beside the checkout), and Debian's assimp-testmodels. The rate
// of everything that has to do with text is in bytes of text, so that stages of one file compare;
// forward kinematics says microseconds per frame, too. For quotable figures:
//   build/bench/io_bench --benchmark_repetitions=5 --benchmark_report_aggregates_only=true
#include <filesystem>
#include <functional>
#include <random>

#include <benchmark/benchmark.h>

#include "moclean/formats/amc.hpp"
#include "moclean/formats/bvh.hpp"
#include "moclean/formats/csv.hpp"
#include "moclean/formats/file.hpp"
#include "moclean/formats/find_skeleton.hpp"
#include "moclean/formats/npy.hpp"
#include "moclean/formats/read_write.hpp"

#include "support/file_bench.hpp"

namespace moclean::bench {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> takes() {
  std::vector<fs::path> found;
  for (const fs::path& file : {shared_data() / "cmu/14/14_06.amc", shared_data() / "bvh/131_01.bvh",
                               fs::path("/usr/share/assimp/models/BVH/01_03.bvh"),
                               fs::path("/usr/share/assimp/models/BVH/Boxing_Toes.bvh")})
    if (fs::exists(file)) found.push_back(file);
  return found;
}

// A take in every form it goes through.
struct Take {
  fs::path file;
  std::string text;
  std::function<SkeletonMotion(std::string_view)> parser;
  SkeletonMotion motion;
  Recording clip;

  SkeletonMotion parse() const { return parser(text); }
};

Take open(const fs::path& file) {
  Take take{.file = file, .text = read_file(file), .parser = {}, .motion = {}, .clip = {}};
  if (file.extension() == ".amc") {
    const fs::path asf = find_skeleton(file);
    const AcclaimSkeleton skeleton = parse_asf(read_file(asf), asf);
    take.parser = [=](std::string_view text) { return parse_amc(text, file, skeleton); };
  } else {
    take.parser = [=](std::string_view text) { return parse_bvh(text, file); };
  }
  take.motion = take.parse();
  take.clip = joint_positions(take.motion);
  return take;
}

// The clip as a file of that extension, gone at the end.
struct Written {
  Written(const Recording& clip, const std::string& extension)
      : file(fs::temp_directory_path() /
             ("moclean-io-bench-" + std::to_string(std::random_device()()) + extension)) {
    write_recording(file, clip);
  }
  ~Written() { fs::remove(file); }
  fs::path file;
};

void count(benchmark::State& state, std::size_t bytes) {
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes));
}

void parse(benchmark::State& state, const fs::path& file) {
  const Take take = open(file);
  for (auto iteration : state) benchmark::DoNotOptimize(take.parse());
  count(state, take.text.size());
}

void kinematics(benchmark::State& state, const fs::path& file) {
  const Take take = open(file);
  for (auto iteration : state)
    benchmark::DoNotOptimize(forward_kinematics(take.motion.skeleton, take.motion.channels));
  count(state, take.text.size());
  using benchmark::Counter;
  const auto frames = static_cast<double>(state.iterations() * take.clip.frames());
  state.counters["s/frame"] = Counter(frames, Counter::kIsRate | Counter::kInvert);
}

// The file in the page cache, parsing and kinematics.
void read(benchmark::State& state, const fs::path& file) {
  for (auto iteration : state) benchmark::DoNotOptimize(read_recording(file));
  count(state, fs::file_size(file));
}

void read_written(benchmark::State& state, const fs::path& file, const std::string& extension) {
  const Written written(read_recording(file), extension);
  for (auto iteration : state) benchmark::DoNotOptimize(read_recording(written.file));
  count(state, fs::file_size(written.file));
}

void write(benchmark::State& state, const fs::path& file, const std::string& extension) {
  const Recording clip = read_recording(file);
  const Written written(clip, extension);
  for (auto iteration : state) write_recording(written.file, clip);
  count(state, fs::file_size(written.file));
}

// Into the text it was read from, every tenth sample changed.
void write_again(benchmark::State& state, const fs::path& file) {
  const Written first(read_recording(file), ".csv"), again(read_recording(file), ".csv");
  Recording recording = read_recording(first.file);
  for (Index i = 0; i < recording.samples.size(); i += 10) recording.samples.data()[i] += 1;
  for (auto iteration : state) write_recording(again.file, recording);
  if (read_recording(again.file).samples != recording.samples)
    state.SkipWithError("other samples were written");
  count(state, fs::file_size(again.file));
}

void add(const std::string& name, const std::function<void(benchmark::State&)>& run) {
  benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMillisecond);
}

void add_all() {
  for (const fs::path& file : takes()) {
    const std::string name = file.filename().string();
    add("parse/" + name, [file](auto& state) { parse(state, file); });
    add("kinematics/" + name, [file](auto& state) { kinematics(state, file); });
    add("read/" + name, [file](auto& state) { read(state, file); });
  }
  if (takes().empty()) return;
  const fs::path file = takes().front();
  for (const std::string extension : {".csv", ".npy", ".c3d"}) {
    const std::string name = file.stem().string() + extension;
    add("write/" + name, [=](auto& state) { write(state, file, extension); });
    add("read/" + name, [=](auto& state) { read_written(state, file, extension); });
  }
  add("write_again/" + file.stem().string() + ".csv",
      [=](auto& state) { write_again(state, file); });
}

}  // namespace
}  // namespace moclean::bench

int main(int argc, char** argv) {
  return moclean::bench::run_benchmarks(argc, argv, moclean::bench::add_all);
}
