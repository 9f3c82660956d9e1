#pragma once

#include <filesystem>
#include <string>

namespace moclean {

/// The extension of a file in lower case, with its dot.
inline std::string extension(const std::filesystem::path& file) {
  std::string text = file.extension().string();
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

}  // namespace moclean
