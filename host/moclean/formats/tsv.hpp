#pragma once

#include "moclean/formats/format.hpp"

namespace moclean {

/// Tab-separated values (.tsv): those that Qualisys Track Manager exports, and any table that
/// parse_csv() reads. A recording of such a file is written into its text, any other as a table of
/// names and rows.
extern const Format tsv_format;

}  // namespace moclean
