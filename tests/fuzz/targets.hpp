#pragma once

#include <string_view>

// One function per target; each has a source of its name. They throw Violation.
namespace moclean::fuzz {

void amc(std::string_view input);  // over the skeleton of tiny_files.hpp
void asf(std::string_view input);
void bvh(std::string_view input);
void c3d(std::string_view input);
void cells(std::string_view input);    // of an experiment that goes on
void columns(std::string_view input);  // a line of --columns or --layout, then a table
void config(std::string_view input);   // of --config
void csv(std::string_view input);
void grid(std::string_view input);      // of an experiment
void manifest(std::string_view input);  // of a folder of results
void method(std::string_view input);    // of --method
void mot(std::string_view input);       // .sto likewise
void noise(std::string_view input);     // of --noise
void npy(std::string_view input);
void npz(std::string_view input);
void trc(std::string_view input);
void tsv(std::string_view input);     // .txt likewise
void tuning(std::string_view input);  // a file that `moclean tune` has left
void values(std::string_view input);  // of options that take more than a number

using Run = void (*)(std::string_view input);

/// One of them; all names are those of input_kinds().
Run target_named(std::string_view name);

}  // namespace moclean::fuzz
