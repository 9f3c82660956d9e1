#include "fuzz/seeds.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include "moclean/formats/file.hpp"
#include "moclean/formats/format.hpp"
#include "moclean/formats/npz.hpp"

#include "experiment/grid_text.hpp"
#include "formats/c3d_maker.hpp"
#include "formats/npy_maker.hpp"
#include "formats/tiny_files.hpp"
#include "fuzz/seed_texts.hpp"
#include "fuzz/target.hpp"

namespace moclean::fuzz {
namespace {

namespace fs = std::filesystem;

using Contents = std::vector<std::string>;

Contents texts(std::initializer_list<std::string_view> texts) {
  return {texts.begin(), texts.end()};
}

Contents arrays() {
  using test::bytes, test::dictionary, test::npy;
  const auto point = {1.5, -2., 3., 4., 5., 6.};
  return {npy(dictionary("<f8", false, "(2, 3)"), bytes<double>(point)),
          npy(dictionary("<f8", true, "(3, 2)"), bytes<double>(point)),
          npy(dictionary(">f4", false, "(1, 2, 3)"), bytes<float>(point, true), 2),
          npy(dictionary("<f4", false, "(1, 3, 2)"), bytes<float>(point), 3),
          npy(dictionary("<f2", true, "(2, 1, 3)"), std::string(12, '\x3c')),
          npy(dictionary("<i2", false, "(2, 3)"), bytes<std::int16_t>(point)),
          npy(dictionary("|u1", false, "(6,)"), bytes<std::uint8_t>({1, 2, 3, 4, 5, 6})),
          npy(dictionary(">i8", false, "(1, 1, 6, 1)"), bytes<std::int64_t>(point, true)),
          npy(dictionary("<f8", false, "(1, 1, 4)"), bytes<double>({1, 2, 3, 0.5})),
          npy(dictionary("<f8", false, "(1, 2, 3)"), bytes<double>(point)),
          npy(dictionary("<U2", false, "(2,)"), std::string(16, 'a'))};
}

Contents archives() {
  // Written by the program: its archives are as those of numpy.savez, stored and without dates.
  Contents all;
  const fs::path file = as_file("");
  for (const Index columns : {Index{6}, Index{4}}) {
    Recording recording{.samples = Matrix::Constant(2, columns, 1.5),
                        .columns = default_column_names(columns),
                        .frame_rate = 120,
                        .unit = "mm"};
    recording.samples(0, 1) = std::nan("");
    AtomicFile target(file);
    write_npz(target, recording);
    target.commit();
    all.push_back(read_file(file));
    static_cast<void>(as_file(""));
  }
  return all;
}

Contents c3d_files() {
  Contents all;
  for (const int processor : {84, 85, 86}) {
    test::C3dMaker maker;
    maker.processor = processor;
    all.push_back(maker.bytes());
    maker.scale = 0.5;
    maker.frames = {{1, 2, 3, 0, 4, 5, 6, 257, 7, 8}, {9, 10, 11, 0, 0, 0, 0, -1, 12, 13}};
    all.push_back(maker.bytes());
  }
  test::C3dMaker named;
  named.parameters =
      named.texts(1, "ANGLES", {"knee"}) + named.text(1, "Y_SCREEN", "+Z") +
      named.group(2, "TRIAL") +
      named.parameter(2, "ACTUAL_END_FIELD", 2, {2}, named.word(2) + named.word(0)) +
      named.parameter(2, "ACTUAL_START_FIELD", 2, {2}, named.word(1) + named.word(0));
  all.push_back(named.bytes());
  return all;
}

Contents made_for(std::string_view target) {
  if (target == "amc") return texts({test::tiny_amc});
  if (target == "asf") return texts({test::tiny_asf});
  if (target == "bvh") return texts({test::tiny_bvh, other_bvh});
  if (target == "c3d") return c3d_files();
  if (target == "cells") return texts({cells_text});
  if (target == "columns") return column_texts();
  if (target == "config") return texts({config_text});
  if (target == "csv" || target == "tsv") return table_texts();
  if (target == "grid") return texts({test::grid_text, other_grid});
  if (target == "manifest") return texts({manifest_text});
  if (target == "method") return method_texts();
  if (target == "mot") return texts({test::tiny_mot});
  if (target == "noise") return noise_texts();
  if (target == "npy") return arrays();
  if (target == "npz") return archives();
  if (target == "trc") return texts({test::tiny_trc});
  if (target == "tuning") return texts({tuning_text});
  if (target == "values") return texts({"2800:", ":17", "0:9223372036854775807", "1.5GiB", "64k"});
  return {};
}

bool is_of_kind(const InputKind& kind, const fs::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::string name = file.filename().string();
  const std::string list = std::string(kind.extensions) + " ";
  const auto is_listed = [&](const std::string& text) {
    return list.find(text + " ") != list.npos;
  };
  return (!extension.empty() && is_listed(extension)) ||
         is_listed("." + name.substr(0, name.find('-')));
}

}  // namespace

std::span<const InputKind> input_kinds() {
  static constexpr std::array<InputKind, 19> all = {{
      {"amc", ".amc"},      {"asf", ".asf"},        {"bvh", ".bvh"},     {"c3d", ".c3d"},
      {"cells", ""},        {"columns", ""},        {"config", ".toml"}, {"csv", ".csv"},
      {"grid", ".toml"},    {"manifest", ".jsonl"}, {"method", ""},      {"mot", ".mot .sto"},
      {"noise", ""},        {"npy", ".npy"},        {"npz", ".npz"},     {"trc", ".trc"},
      {"tsv", ".tsv .txt"}, {"tuning", ".json"},    {"values", ""},
  }};
  return all;
}

std::vector<Seed> seeds_of(const InputKind& kind) {
  std::vector<Seed> seeds;
  for (std::string& content : made_for(kind.target))
    seeds.push_back({fmt::format("made-{}", seeds.size()), std::move(content)});
  for (Seed& seed : seeds_below(fs::path(MOCLEAN_TEST_DATA) / "malformed", kind))
    seeds.push_back(std::move(seed));
  return seeds;
}

std::vector<Seed> seeds_below(const fs::path& folder, const InputKind& kind) {
  constexpr std::uintmax_t most = 64 << 10;
  std::vector<Seed> seeds;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.file_size() <= most && is_of_kind(kind, entry.path())) {
      std::string name = fs::relative(entry.path(), folder).string();
      std::ranges::replace(name, '/', '-');
      seeds.push_back({std::move(name), read_file(entry.path())});
    }
  std::ranges::sort(seeds, {}, &Seed::name);
  return seeds;
}

}  // namespace moclean::fuzz
