#pragma once

#include <algorithm>
#include <bit>
#include <initializer_list>
#include <string>

#include <fmt/format.h>

namespace moclean::test {

// What numpy.save writes, put together by hand.
inline std::string npy(const std::string& header, const std::string& data, int version = 1) {
  std::string file = "\x93NUMPY";
  file += static_cast<char>(version);
  file += '\0';
  const std::string line = header + "\n";
  for (int i = 0; i < (version == 1 ? 2 : 4); ++i)
    file += static_cast<char>(line.size() >> (8 * i) & 0xFF);
  return file + line + data;
}

inline std::string dictionary(const std::string& descr, bool fortran, const std::string& shape) {
  return fmt::format("{{'descr': '{}', 'fortran_order': {}, 'shape': {}, }}", descr,
                     fortran ? "True" : "False", shape);
}

// Samples as bytes of the given type, least significant byte first or last.
template <class Real>
std::string bytes(std::initializer_list<double> values, bool big_endian = false) {
  std::string all;
  for (const double value : values) {
    const auto real = static_cast<Real>(value);
    std::string one(reinterpret_cast<const char*>(&real), sizeof real);
    if (big_endian != (std::endian::native == std::endian::big))
      std::reverse(one.begin(), one.end());
    all += one;
  }
  return all;
}

}  // namespace moclean::test
