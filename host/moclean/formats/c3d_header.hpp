#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "moclean/formats/c3d_file.hpp"
#include "moclean/formats/c3d_parameters.hpp"

namespace moclean {

/// The first blocks of a C3D file that is to be written: the header, what stands between it and the
/// parameters, and the four bytes that those begin with.
class C3dHeader {
 public:
  /// Bytes of its numbers (c3d.org, "The header section").
  static constexpr std::size_t points = 2, analog = 4, first_frame = 6, last_frame = 8,
                               longest_gap = 10, scale = 12, data_block = 16, analog_per_frame = 18,
                               rate = 20, event_key = 298;

  explicit C3dHeader(C3dNumbers numbers);  ///< an empty one

  /// That of a file; its parameters move before its data if they are behind them.
  explicit C3dHeader(const C3dFile& c3d);

  void set_word(std::size_t at, double value);  ///< at most 65535 is stored
  void set_real(std::size_t at, double value);

 private:
  friend std::string c3d_front(C3dHeader, C3dParameters, std::string_view,
                               const std::filesystem::path&);

  C3dNumbers numbers_;
  std::string bytes_;     // up to the parameters
  std::string prologue_;  // of the parameters, 4 bytes
  std::size_t room_ = 0;  // bytes for the parameters, up to the data
};

/// All of a C3D file before its data: where the parameters have outgrown their room, the data begin
/// later, and header and POINT:DATA_START say so. The group `optional` is left out where the
/// section cannot hold it: it has at most 255 blocks. Throws FileError if it cannot hold the rest.
std::string c3d_front(C3dHeader header, C3dParameters parameters, std::string_view optional,
                      const std::filesystem::path& file);

/// Sets TRIAL:ACTUAL_START_FIELD and ACTUAL_END_FIELD, 32 bits in two words, where they exist.
void set_c3d_trial(C3dParameters& parameters, Index first, Index last);

/// The zeros that fill the last block.
std::string c3d_padding(std::size_t bytes);

}  // namespace moclean
