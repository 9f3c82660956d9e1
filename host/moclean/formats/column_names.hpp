#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace moclean {

/// How a name joins a point and a coordinate, in the order in which readings of names are
/// preferred.
enum class NameStyle {
  suffix,    ///< `hip.x`, `hip_X`, `hip-x`, `hip:X`, `hip x`, `hip/x`
  brackets,  ///< `x(hip)`, `hip[x]`
  prefix,    ///< `x.hip`, `X_hip`, `X hip`
  position,  ///< `hip.Xposition`
  shifted,   ///< `hip_tx`, as joints call their translations, too
  numbered,  ///< `x1`, `Y12`
  bare,      ///< `x`
  glued      ///< `hipX`, `LFHDx`, `xHip`: the letter's case or what stands before it sets it apart
};

/// One reading of a column's name as a coordinate of a point.
struct AxisName {
  NameStyle style = NameStyle::suffix;
  char joint = 0;           ///< the character between point and letter, 0 if there is none
  std::string point;        ///< empty if the name has only the letter
  char axis = 'x';          ///< x, y or z, or w (of quaternions, and of boxes)
  std::string remark = {};  ///< that it is a position, `_pos` of `hip_pos_x`, `_3d` of `hip_x_3d`
};

/// All readings of a name as a coordinate, the preferred one first; a unit behind it (`hip x (mm)`)
/// does not count.
std::vector<AxisName> axis_names(std::string_view name);

/// The unit that a name ends with in brackets, `mm` of `hip x (mm)`; empty if it has none that is
/// known.
std::string unit_of_name(std::string_view name);

/// Whether a word is a unit of length, time, angle or of pictures.
bool is_unit(std::string_view word);

/// Whether a word is a unit of length or of pictures.
bool is_length_unit(std::string_view word);

/// What a column measures if its name tells of something else than of a place.
enum class NamedQuantity { none, time, frame, running, confidence, angle, rate_of_change };

/// By its words: `Time (Seconds)`, `timestamp`, `t_ms` are times; `Frame`, `fnum` number frames;
/// `index`, `Unnamed: 0`, `id` do if their values count; `likelihood`, `score`, ... say how sure a
/// point is; `rot`, `quat`, `angle`, ... are angles; `vel`, `acc`, `force`, ... are vectors that
/// are no places.
NamedQuantity named_quantity(std::string_view name);

/// What a last letter by itself tells of names like `RX`, `pelvis_Oy` or `Fz`: rotations,
/// orientations, quaternions, forces, moments.
NamedQuantity quantity_of_letter(std::string_view point);

/// Seconds per unit of a time column as its name says, `time_ms` or `Time (Seconds)`; 0 if it does
/// not.
double seconds_per_unit(std::string_view name);

/// Points, in lower case, of which a column may say how sure they are: `hip` of `Hip_likelihood`,
/// `hip.score`, `confidence hip`, `hipScore`, `1` of `v1`; the empty one of a bare `likelihood`.
std::vector<std::string> points_judged_by(std::string_view name);

/// Gives names that come again a number: `hip`, `hip_2`, `hip_3`.
class DistinctNames {
 public:
  std::string operator()(const std::string& name) {
    int& count = counts_[name];
    std::string distinct = name;
    for (count = std::max(count, 1); !used_.insert(distinct).second; ++count)
      distinct = name + "_" + std::to_string(count + 1);
    return distinct;
  }

 private:
  std::unordered_map<std::string, int> counts_;  // of numbers that were tried
  std::unordered_set<std::string> used_;
};

/// Lower case of ASCII.
std::string in_lower_case(std::string_view text);

}  // namespace moclean
