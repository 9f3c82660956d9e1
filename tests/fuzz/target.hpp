#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace moclean::fuzz {

/// A promise that was not kept.
class Violation : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Calls `parse`, which may throw errors of moclean's alone, with messages that can be shown.
/// Returns whether it came to its end.
bool succeeds(const std::function<void()>& parse);

/// Throws Violation unless a text is, as it is printed, UTF-8 without controls.
void expect_showable(std::string_view text);

/// A file of this content; the same path every time.
std::filesystem::path as_file(std::string_view content);

/// Likewise, with this name, in a folder where nothing else is.
std::filesystem::path as_file_named(const std::string& name, std::string_view content);

}  // namespace moclean::fuzz
