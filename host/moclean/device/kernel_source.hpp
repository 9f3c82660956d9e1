#pragma once

#include <string_view>

/// The files of kernels/, embedded by the build; each begins with a #line directive.
namespace moclean::kernel_source {

extern const std::string_view prelude;
extern const std::string_view eigen;
extern const std::string_view norms;
extern const std::string_view products;
extern const std::string_view robust_pca;
extern const std::string_view scale_rows;

}  // namespace moclean::kernel_source
