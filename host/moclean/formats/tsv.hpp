#pragma once

#include "moclean/formats/format.hpp"

namespace moclean {

/// Tab-separated values (.tsv): those that Qualisys Track Manager exports, and any table that
/// parse_csv() reads. A recording of such a file is written into its text, any other as a table of
/// names and rows.
extern const Format tsv_format;

/// Any other text with a table (.txt): of QTM, Vicon Nexus or numpy.savetxt, whose first lines tell
/// the separator. Likewise; folders of recordings leave such files out, as they may be any text.
extern const Format txt_format;

}  // namespace moclean
