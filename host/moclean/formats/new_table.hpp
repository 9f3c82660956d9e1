#pragma once

#include "moclean/formats/file.hpp"
#include "moclean/motion/recording.hpp"

namespace moclean {

/// Writes a recording as a new table that read_table() reads back to the same bits: comments with
/// rate, unit and upward axis, a line of names, the shortest text for every number, `nan` for any
/// NaN. A name that a spreadsheet would execute (it begins with `=`, `+`, `-` or `@` and is no
/// number) gets an apostrophe before it and quotes around it, as OWASP advises against CSV
/// injection; so do names that are all numbers, which would be a row of samples. read_table() takes
/// the apostrophe off again. Throws FileError for a name with a line break.
void write_new_table(AtomicFile& file, const Recording& recording, char separator);

}  // namespace moclean
