#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace moclean::fuzz {

/// An input that a target begins with.
struct Seed {
  std::string name;
  std::string content;
};

/// Which files are inputs of a target.
struct InputKind {
  std::string_view target;      ///< its name
  std::string_view extensions;  ///< each with its dot
};

/// Those of all targets.
std::span<const InputKind> input_kinds();

/// The inputs of a kind that are made, and the files in tests/data.
std::vector<Seed> seeds_of(const InputKind& kind);

/// The files of a kind anywhere below a folder, but for those of more than 64 KiB. A name that
/// begins like `csv-` is of the kind of .csv.
std::vector<Seed> seeds_below(const std::filesystem::path& folder, const InputKind& kind);

}  // namespace moclean::fuzz
