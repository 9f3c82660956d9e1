#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class Validator;
}

namespace moclean::cli {

/// Validators of option values, whose messages say what is allowed in words.

/// A number above 0.
CLI::Validator positive_number();

/// A number of at least 0.
CLI::Validator number_from_zero();

/// Any number but infinity and NaN.
CLI::Validator number();

/// A number above a bound.
CLI::Validator number_above(double bound);

/// A number within bounds.
CLI::Validator number_between(double least, double most);

/// A whole number within bounds.
CLI::Validator whole_number(std::int64_t least, std::int64_t most = INT64_MAX - 1);

/// A whole number of 64 bits without sign.
CLI::Validator seed_number();

/// One of some names; the message of another has the nearest.
CLI::Validator one_of(std::vector<std::string> names);

}  // namespace moclean::cli
