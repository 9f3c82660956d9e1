#include "fuzz/target.hpp"

#include <cstdlib>
#include <fstream>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "moclean/core/error.hpp"
#include "moclean/core/printable.hpp"

namespace moclean::fuzz {
namespace {

namespace fs = std::filesystem;

// Decodes a character off the front of a text, apart from what the library does for it; throws
// Violation if none begins there.
char32_t take_character(std::string_view& text) {
  const auto byte = [&](std::size_t i) -> char32_t {
    if (i >= text.size()) throw Violation("a character is cut short");
    return static_cast<unsigned char>(text[i]);
  };
  const auto tail = [&](std::size_t i) {
    if (byte(i) < 0x80 || byte(i) > 0xBF) throw Violation("a byte is no part of a character");
    return byte(i) - 0x80;
  };
  const char32_t lead = byte(0);
  char32_t code = lead;
  std::size_t length = 1;
  if (lead >= 0xF0) {
    length = 4;
    code = (lead - 0xF0) << 18 | tail(1) << 12 | tail(2) << 6 | tail(3);
    if (code < 0x10000 || code > 0x10FFFF) throw Violation("a character is none of Unicode's");
  } else if (lead >= 0xE0) {
    length = 3;
    code = (lead - 0xE0) << 12 | tail(1) << 6 | tail(2);
    if (code < 0x800 || (code >= 0xD800 && code <= 0xDFFF)) throw Violation("overlong, surrogate");
  } else if (lead >= 0x80) {
    length = 2;
    if (lead < 0xC2) throw Violation("a byte begins no character");
    code = (lead - 0xC0) << 6 | tail(1);
  }
  text.remove_prefix(length);
  return code;
}

bool is_control(char32_t code) {
  return code < 0x20 || (code >= 0x7F && code <= 0x9F) || (code >= 0x2028 && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069) || code == 0xFEFF || code == 0x200E || code == 0x200F;
}

// Overwritten for every input: to make a file takes longer than to read it.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("input", MFD_CLOEXEC)) {
    if (descriptor_ < 0) throw std::runtime_error("memfd_create fails");
  }

  fs::path hold(std::string_view content) const {
    if (ftruncate(descriptor_, 0) != 0 || pwrite(descriptor_, content.data(), content.size(), 0) !=
                                              static_cast<ssize_t>(content.size()))
      throw std::runtime_error("a file in memory cannot be written");
    return fmt::format("/proc/self/fd/{}", descriptor_);
  }

 private:
  int descriptor_;
};

class OwnFolder {
 public:
  OwnFolder() {
    std::string name = (fs::temp_directory_path() / "moclean-fuzz-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no folder can be made");
    path_ = name;
  }
  ~OwnFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

void expect_showable(std::string_view text) {
  const std::string line = printable_line(text);
  for (std::string_view rest = line; !rest.empty();)
    if (is_control(take_character(rest))) throw Violation("a message holds a control character");
}

bool succeeds(const std::function<void()>& parse) {
  try {
    parse();
    return true;
  } catch (const Error& error) {
    if (std::string_view(error.what()).empty()) throw Violation("an error says nothing");
    expect_showable(error.what());
  } catch (const Violation&) {
    throw;
  } catch (const std::exception& error) {
    throw Violation(fmt::format("an exception that is not moclean's: {}", error.what()));
  }
  return false;
}

fs::path as_file(std::string_view content) {
  static const MemoryFile file;
  return file.hold(content);
}

fs::path as_file_named(const std::string& name, std::string_view content) {
  static const OwnFolder folder;
  const fs::path file = folder.path() / name;
  std::ofstream(file, std::ios::binary) << content;
  return file;
}

}  // namespace moclean::fuzz
