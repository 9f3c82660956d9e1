#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace moclean::test {

/// A C3D file put together byte by byte, apart from what the library does to write one.
struct C3dMaker {
  int processor = 84;  ///< 84 Intel, 85 DEC, 86 MIPS
  double scale = -1;   ///< negative: reals
  double rate = 120;
  std::vector<std::string> labels = {"hip", "knee"};

  /// Per frame x, y, z and the word of every point, as stored (integers not yet scaled), then the
  /// analog samples.
  std::vector<std::vector<double>> frames = {{1, 2, 3, 0, 4, 5, 6, 257}, {7, 8, 9, 0, 0, 0, 0, -1}};

  int points = 2;
  int first_frame = 1;
  int header_last = 0;          ///< 0: what is right
  int stated_frames = -1;       ///< POINT:FRAMES; -1: what is right
  std::string parameters = {};  ///< more groups and parameters; POINT has id 1
  int parameter_block = 2;
  int parameter_blocks = 1;
  int data_block = 0;                         ///< 0: behind the parameters
  std::string ending = std::string(2, '\0');  ///< of the records

  std::string word(int value) const {
    const auto low = static_cast<char>(value & 0xFF), high = static_cast<char>(value >> 8 & 0xFF);
    return processor == 86 ? std::string{high, low} : std::string{low, high};
  }

  /// A VAX's real has the bits of the IEEE one of four times the value, high word first.
  std::string real(double value) const {
    const auto ieee = static_cast<float>(processor == 85 ? 4 * value : value);
    const auto bits = std::bit_cast<std::uint32_t>(ieee);
    const std::string high = word(static_cast<int>(bits >> 16)),
                      low = word(static_cast<int>(bits & 0xFFFF));
    return processor == 84 ? low + high : high + low;
  }

  std::string group(int id, const std::string& name) const {
    return static_cast<char>(name.size()) + std::string(1, static_cast<char>(-id)) + name +
           word(3) + std::string(1, '\0');
  }

  std::string parameter(int id, const std::string& name, int type, const std::vector<int>& extents,
                        const std::string& data) const {
    std::string body{static_cast<char>(type), static_cast<char>(extents.size())};
    for (const int extent : extents) body += static_cast<char>(extent);
    body += data + '\0';
    return static_cast<char>(name.size()) + std::string(1, static_cast<char>(id)) + name +
           word(static_cast<int>(body.size()) + 2) + body;
  }

  std::string text(int id, const std::string& name, const std::string& text) const {
    return parameter(id, name, -1, {static_cast<int>(text.size())}, text);
  }

  std::string texts(int id, const std::string& name, const std::vector<std::string>& texts) const {
    std::string data;
    for (std::string text : texts) {
      text.resize(12, ' ');
      data += text;
    }
    return parameter(id, name, -1, {12, static_cast<int>(texts.size())}, data);
  }

  std::string number(double value) const {
    return scale < 0 ? real(value) : word(static_cast<int>(value));
  }

  std::string header(int data_at) const {
    const int count = static_cast<int>(frames.size());
    const int analog = static_cast<int>(frames[0].size()) - 4 * points;
    std::string bytes{static_cast<char>(parameter_block), '\x50'};
    bytes += word(points) + word(analog) + word(first_frame) +
             word(header_last ? header_last : first_frame + count - 1) + word(10) + real(scale) +
             word(data_at) + word(1) + real(rate);
    bytes.resize(512, '\0');
    return bytes;
  }

  std::string section(int data_at) const {
    const int count = stated_frames < 0 ? static_cast<int>(frames.size()) : stated_frames;
    std::string bytes = std::string("\x01\x50", 2) + static_cast<char>(parameter_blocks) +
                        static_cast<char>(processor);
    bytes += group(1, "POINT") + parameter(1, "USED", 2, {}, word(points)) +
             parameter(1, "FRAMES", 2, {}, word(count)) +
             parameter(1, "SCALE", 4, {}, real(scale)) + parameter(1, "RATE", 4, {}, real(rate)) +
             parameter(1, "DATA_START", 2, {}, word(data_at)) + text(1, "UNITS", "mm  ") +
             texts(1, "LABELS", labels) + parameters + ending;
    bytes.resize(static_cast<std::size_t>(512 * parameter_blocks), '\0');
    return bytes;
  }

  std::string data() const {
    std::string bytes;
    for (const auto& frame : frames)
      for (const double value : frame) bytes += number(value);
    bytes.resize((bytes.size() + 511) / 512 * 512, '\0');
    return bytes;
  }

  std::string bytes() const {
    const int data_at = data_block ? data_block : parameter_block + parameter_blocks;
    const bool is_before = data_at > parameter_block;
    std::string all = header(data_at);
    if (!is_before) all += data();
    all.resize(static_cast<std::size_t>(512 * (parameter_block - 1)), '\0');
    all += section(data_at);
    return is_before ? all + data() : all;
  }
};

}  // namespace moclean::test
