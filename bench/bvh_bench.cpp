// Writing of BVH from joint positions: rotations are fitted to them
// (motion/inverse_kinematics.hpp), then written. 10 000 frames of a real take, whose joints are
// turned by up to one or five degrees, so that the fit begins away from its end; into the text the
// take was read from, and as a new file. The file is read again before a time counts: each joint
// has to stand within 1e-4 of the body's height. Seconds of time, on all threads:
//   taskset -c 0,1 build/bench/bench/bvh_bench --benchmark_repetitions=5
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "moclean/formats/read_write.hpp"

#include "support/file_bench.hpp"

namespace moclean::bench {
namespace {

namespace fs = std::filesystem;

constexpr Index frames = 10000;

std::vector<fs::path> takes() {
  std::vector<fs::path> found;
  for (const fs::path& file :
       {shared_data() / "bvh/131_01.bvh", fs::path("/usr/share/assimp/models/BVH/01_03.bvh"),
        fs::path("/usr/share/assimp/models/BVH/Boxing_Toes.bvh")})
    if (fs::exists(file)) found.push_back(file);
  return found;
}

// There and back again until there are 10 000 frames.
Index frame_of(Index frame, Index length) {
  const Index place = frame % (2 * length);
  return place < length ? place : 2 * length - 1 - place;
}

// The extent of the joints along the axis they extend along most, in the first frame.
double height(const Recording& take) {
  double most = 0;
  for (Index axis = 0; axis < 3; ++axis) {
    double low = take.samples(0, axis), high = low;
    for (Index c = axis; c < take.samples.cols(); c += 3) {
      low = std::min(low, take.samples(0, c));
      high = std::max(high, take.samples(0, c));
    }
    most = std::max(most, high - low);
  }
  return most;
}

// Channels of the take, positions of one that is turned: slowly varying angles are added to all
// rotations.
Recording long_take(const fs::path& file, double degrees) {
  const Recording read = read_recording(file);
  Recording take = read;
  take.channels.resize(frames, read.channels.cols());
  for (Index f = 0; f < frames; ++f)
    take.channels.row(f) = read.channels.row(frame_of(f, read.frames()));
  Matrix turned = take.channels;
  Index column = 0;
  for (const Bone& bone : take.skeleton->bones)
    for (const Channel channel : bone.channels) {
      if (!is_translation(channel))
        for (Index f = 0; f < frames; ++f)
          turned(f, column) +=
              degrees * std::numbers::pi / 180 *
              std::sin(0.02 * static_cast<double>(f) + static_cast<double>(column));
      ++column;
    }
  take.samples = forward_kinematics(*take.skeleton, turned);
  return take;
}

// Gone at the end.
struct Written {
  fs::path file = fs::temp_directory_path() /
                  ("moclean-bvh-bench-" + std::to_string(std::random_device()()) + ".bvh");
  ~Written() { fs::remove(file); }
};

double largest_error(const Recording& take, const fs::path& file) {
  const Recording read = read_recording(file);
  if (read.frames() != take.frames() || read.samples.cols() < take.samples.cols())
    return std::numeric_limits<double>::infinity();
  double most = 0;  // the new file may have joints of its own, under other names
  for (std::size_t c = 0; c < take.columns.size(); ++c) {
    const auto place = std::find(read.columns.begin(), read.columns.end(), take.columns[c]);
    if (place == read.columns.end()) return std::numeric_limits<double>::infinity();
    const auto column = static_cast<Index>(place - read.columns.begin());
    most = std::max(
        most,
        (read.samples.col(column) - take.samples.col(static_cast<Index>(c))).cwiseAbs().maxCoeff());
  }
  return most;
}

void write(benchmark::State& state, const Recording& take) {
  const Written written;
  write_recording(written.file, take);
  const double error = largest_error(take, written.file) / height(take);
  if (!(error <= 1e-4)) state.SkipWithError("a joint is elsewhere");
  for (auto iteration : state) write_recording(written.file, take);
  state.counters["error/height"] = error;
  state.SetBytesProcessed(state.iterations() *
                          static_cast<std::int64_t>(fs::file_size(written.file)));
}

void add(const std::string& name, const Recording& take) {
  benchmark::RegisterBenchmark(name.c_str(), [take](auto& state) { write(state, take); })
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}

// The take as a new file, and into a text of as many frames.
void add_take(const fs::path& file, double degrees) {
  const std::string name =
      file.filename().string() + "/degrees:" + std::to_string(static_cast<int>(degrees));
  Recording take = long_take(file, degrees);
  take.source = {};
  add("new/" + name, take);
  const Written text;
  Recording start = take;
  start.samples = forward_kinematics(*take.skeleton, take.channels);
  write_recording(text.file, start);
  Recording again = read_recording(text.file);
  if (again.samples.cols() != take.samples.cols()) return;  // the text has joints of its own
  again.samples = take.samples;
  add("again/" + name, again);
}

void add_all() {
  for (const fs::path& file : takes())
    for (const double degrees : {1, 5}) add_take(file, degrees);
}

}  // namespace
}  // namespace moclean::bench

int main(int argc, char** argv) {
  return moclean::bench::run_benchmarks(argc, argv, moclean::bench::add_all);
}
