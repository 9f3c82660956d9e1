#pragma once

#include <string_view>

/// The parts of the page, generated from report/assets and from Debian's libjs-three and
/// libjs-dygraphs by embed.cmake. Those of a library that was not found are empty.
namespace moclean::report_asset {

extern const std::string_view page;      ///< HTML with {{names}} to be replaced
extern const std::string_view style;     ///< CSS
extern const std::string_view script;    ///< our JavaScript, one file after the other
extern const std::string_view licenses;  ///< of the libraries
extern const std::string_view three;
extern const std::string_view orbit_controls;
extern const std::string_view dygraph;
extern const std::string_view dygraph_style;

}  // namespace moclean::report_asset
