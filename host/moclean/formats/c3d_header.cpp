#include "moclean/formats/c3d_header.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

constexpr std::size_t most_blocks = 255, prologue_bytes = 4;

std::size_t blocks_for(std::size_t bytes) { return (bytes + c3d_block - 1) / c3d_block; }

bool fits(const C3dParameters& parameters) {
  return blocks_for(prologue_bytes + parameters.bytes().size()) <= most_blocks;
}

}  // namespace

C3dHeader::C3dHeader(C3dNumbers numbers)
    : numbers_(numbers), bytes_(c3d_block, '\0'), prologue_("\x01\x50\0\0", prologue_bytes) {
  bytes_[0] = 2;
  bytes_[1] = 0x50;
  prologue_[3] = static_cast<char>(numbers.processor());
}

C3dHeader::C3dHeader(const C3dFile& c3d)
    : numbers_(c3d.layout.numbers),
      prologue_(c3d.bytes.substr(c3d.layout.parameter_start, prologue_bytes)) {
  const bool is_before = c3d.layout.parameter_start < c3d.layout.data_start;
  bytes_ = c3d.bytes.substr(0, is_before ? c3d.layout.parameter_start : c3d_block);
  bytes_[0] = static_cast<char>(bytes_.size() / c3d_block + 1);
  if (is_before) room_ = c3d.layout.data_start - c3d.layout.parameter_start;
}

void C3dHeader::set_word(std::size_t at, double value) {
  const auto bytes = numbers_.word_bytes(static_cast<unsigned>(std::clamp(value, 0.0, 65535.0)));
  std::ranges::copy(bytes, bytes_.begin() + static_cast<std::ptrdiff_t>(at));
}

void C3dHeader::set_real(std::size_t at, double value) {
  std::ranges::copy(numbers_.real_bytes(value), bytes_.begin() + static_cast<std::ptrdiff_t>(at));
}

std::string c3d_front(C3dHeader header, C3dParameters parameters, std::string_view optional,
                      const std::filesystem::path& file) {
  if (!fits(parameters)) parameters.remove_group(optional);
  if (!fits(parameters))
    throw FileError(
        file, fmt::format("cannot be written: C3D has no room for {} bytes of names and "
                          "other parameters, only for {}",
                          parameters.bytes().size(), most_blocks * c3d_block - prologue_bytes));
  const std::size_t needed = blocks_for(prologue_bytes + parameters.bytes().size());
  const std::size_t start = header.bytes_.size();
  std::size_t data = start + std::max(header.room_, needed * c3d_block);
  if (data != start + header.room_) {
    const auto block = static_cast<double>(data / c3d_block + 1);
    header.set_word(C3dHeader::data_block, block);
    parameters.set("POINT", "DATA_START", {block});
  }
  const std::size_t stated = static_cast<unsigned char>(header.prologue_[2]);
  header.prologue_[2] = static_cast<char>(std::max(stated, needed));
  std::string front = header.bytes_ + header.prologue_ + parameters.bytes();
  front.resize(data, '\0');
  return front;
}

void set_c3d_trial(C3dParameters& parameters, Index first, Index last) {
  const auto words = [](Index number) {
    return std::vector<double>{static_cast<double>(number & 0xFFFF),
                               static_cast<double>(number >> 16)};
  };
  parameters.set("TRIAL", "ACTUAL_START_FIELD", words(first));
  parameters.set("TRIAL", "ACTUAL_END_FIELD", words(last));
}

std::string c3d_padding(std::size_t bytes) {
  return std::string(blocks_for(bytes) * c3d_block - bytes, '\0');
}

}  // namespace moclean
