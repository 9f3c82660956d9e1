#pragma once

#include <string_view>

namespace moclean {

/// The text of a cell as a number, infinity included; `decimal` is `.` or `,`. False if it is none.
/// A word for a missing sample is no number, except `nan`, which is NaN.
bool table_number(std::string_view text, char decimal, double& value);

/// Whether a cell says that there is no sample: it is empty, or one of the words that programs
/// write, in any case: nan, NA, <NA>, N/A, n.a., null, none, missing, -, --, a point alone, the
/// errors of spreadsheets (#N/A, #NUM!, ...), and 1.#IND, 1.#QNAN, 1.#SNAN of Microsoft's C
/// library, with a sign and zeros behind them.
bool says_missing(std::string_view text);

/// Whether a cell is a number with a decimal point, or one with a decimal comma.
bool has_decimal(std::string_view text, char decimal);

}  // namespace moclean
