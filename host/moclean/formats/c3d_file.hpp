#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "moclean/core/matrix.hpp"
#include "moclean/formats/c3d_numbers.hpp"
#include "moclean/formats/c3d_parameters.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// Where in a C3D file its samples lie and how they are stored: per frame four numbers per point
/// (x, y, z, and the word of residual and cameras), then the analog samples of the frame.
struct C3dLayout {
  C3dNumbers numbers;
  bool is_float = true;  ///< numbers are reals; else integers, and coordinates those times scale
  double scale = 1;      ///< magnitude of POINT:SCALE; residuals are multiples of it
  Index points = 0;
  Index analog = 0;  ///< analog samples per frame, of all channels
  Index frames = 0;
  Index first_frame = 1;            ///< the number of the first frame in the whole trial
  std::size_t parameter_start = 0;  ///< bytes from the beginning of the file
  std::size_t data_start = 0;       ///< likewise

  std::size_t number_bytes() const { return is_float ? 4 : 2; }
  std::size_t frame_bytes() const {
    return static_cast<std::size_t>(4 * points + analog) * number_bytes();
  }
  std::size_t data_bytes() const { return static_cast<std::size_t>(frames) * frame_bytes(); }
};

/// A C3D file: all its bytes, and what they mean.
struct C3dFile {
  std::string bytes;
  C3dLayout layout;
  C3dParameters parameters;

  /// Points that are coordinates, counted from 0. Not so are results of a model that the file says
  /// to be angles, forces, moments, powers or scalars (POINT:ANGLES ..., POINT:TYPE_GROUPS).
  std::vector<Index> coordinates;

  std::vector<std::string> columns;  ///< three per point of `coordinates`
};

constexpr std::size_t c3d_block = 512;  ///< bytes; the file is counted in them

/// Reads header and parameters. `file` names the bytes in messages. Throws FileError.
///
/// The number of frames is stated in up to four places (TRIAL:ACTUAL_START_FIELD and
/// ACTUAL_END_FIELD, POINT:LONG_FRAMES, POINT:FRAMES, the header), of which those of 16 bits are
/// wrong in long files: the first counts that fills the data section to its last block, else the
/// first for which there are bytes enough.
C3dFile parse_c3d_file(std::string_view bytes, const std::filesystem::path& file);

/// Hz, from POINT:RATE, else the header; 0 where neither states one.
double c3d_rate(const C3dFile& c3d);

/// By POINT:Y_SCREEN, the axis that is drawn upwards. Of "-Z", too, it is z: that is what Qualisys
/// writes for takes whose floor is at z = 0.
std::optional<UpAxis> c3d_up(const C3dFile& c3d);

}  // namespace moclean
