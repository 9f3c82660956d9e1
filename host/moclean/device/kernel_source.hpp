#pragma once

#include <string_view>

/// The files of kernels/, embedded by the build; each begins with a #line directive.
namespace moclean::kernel_source {

extern const std::string_view prelude;
extern const std::string_view tridiagonal;
extern const std::string_view tridiagonal_ql;
extern const std::string_view eigenvectors;
extern const std::string_view tridiagonal_group;
extern const std::string_view eigen_group;
extern const std::string_view products_group;
extern const std::string_view sweep_group;
extern const std::string_view completion;
extern const std::string_view banded;
extern const std::string_view conjugate_gradients;
extern const std::string_view partial_grams;
extern const std::string_view norms;
extern const std::string_view norms_group;
extern const std::string_view peak;
extern const std::string_view products;
extern const std::string_view robust_pca;
extern const std::string_view scale_rows;
extern const std::string_view search_direction;
extern const std::string_view search_direction_group;
extern const std::string_view sweep;
extern const std::string_view temporal;
extern const std::string_view temporal_group;

}  // namespace moclean::kernel_source
