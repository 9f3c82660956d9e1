#pragma once

#include <string_view>

namespace moclean::cli {

/// Writes on standard output. Does not throw: a failure is told in the end, by output_failure().
void write_output(std::string_view text);

/// Writes what is still buffered, and gives the error number (errno) of the first failure to write
/// on standard output; 0 if all that was printed has arrived.
int output_failure();

}  // namespace moclean::cli
