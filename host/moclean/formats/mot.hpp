#pragma once

#include "moclean/formats/format.hpp"

namespace moclean {

/// OpenSim's motion and storage files (.mot, .sto): a head up to `endheader`, a line of names, rows
/// that begin with the time. Columns are channels by themselves, joint angles or forces, unless
/// their names tell of points (recognise_columns()); DataType other than double is refused. A
/// recording of such a file is written into its text, any other gets a head of its own; then a rate
/// is needed, for the times.
extern const Format mot_format;
extern const Format sto_format;

}  // namespace moclean
