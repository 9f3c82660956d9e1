#pragma once

#include <string>
#include <string_view>
#include <vector>

// Texts that use much of what may stand in them.
namespace moclean::fuzz {

/// Two roots, names that come twice, all six channels, decimal commas, a frame over two lines.
extern const std::string_view other_bvh;

/// What test::grid_text has not.
extern const std::string_view other_grid;

extern const std::string_view cells_text, config_text, manifest_text, tuning_text;

/// One or more tables of each dialect (docs/formats.md).
std::vector<std::string> table_texts();

/// What the target `columns` takes.
std::vector<std::string> column_texts();

/// Every method and every noise, with its parameters.
std::vector<std::string> method_texts();
std::vector<std::string> noise_texts();

}  // namespace moclean::fuzz
