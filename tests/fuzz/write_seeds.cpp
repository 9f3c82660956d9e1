// write_seeds FOLDER [CASES]: writes the seeds of every target into FOLDER/TARGET, with the files
// below CASES that are of its kind.

#include <cstdio>
#include <exception>
#include <fstream>

#include <fmt/format.h>

#include "fuzz/seeds.hpp"

namespace {

namespace fs = std::filesystem;

void write(const fs::path& folder, const std::vector<moclean::fuzz::Seed>& seeds) {
  fs::create_directories(folder);
  for (const auto& [name, content] : seeds)
    std::ofstream(folder / name, std::ios::binary) << content;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2 || count > 3) {
    std::fputs("usage: write_seeds FOLDER [CASES]\n", stderr);
    return 2;
  }
  try {
    for (const moclean::fuzz::InputKind& kind : moclean::fuzz::input_kinds()) {
      const fs::path folder = fs::path(arguments[1]) / kind.target;
      write(folder, moclean::fuzz::seeds_of(kind));
      if (count == 3) write(folder, moclean::fuzz::seeds_below(arguments[2], kind));
    }
  } catch (const std::exception& error) {
    std::fputs(fmt::format("write_seeds: {}\n", error.what()).c_str(), stderr);
    return 1;
  }
  return 0;
}
