#pragma once

#include <filesystem>
#include <string>

#include "cli/options/denoise_options.hpp"

namespace moclean::cli {

/// Lets a command that works on files work on standard input and output, `-`: through files in a
/// folder of its own, which is removed in the end.
class StandardStreams {
 public:
  /// Reads standard input where that is the input, and puts files in the place of both. Throws
  /// ArgumentError where a format is missing, or something else that is next to the files.
  explicit StandardStreams(DenoiseOptions& options);
  ~StandardStreams();
  StandardStreams(const StandardStreams&) = delete;
  StandardStreams& operator=(const StandardStreams&) = delete;

  /// A text in which the files are called standard input and standard output.
  std::string named(std::string text) const;

  /// Whether the result goes to standard output, which has no room for messages then.
  bool writes() const { return !output_.empty(); }

  /// Writes what has become of the output; nothing where that is a file. Throws FileError if there
  /// is none; that standard output takes all of it is checked when the program ends.
  void send() const;

 private:
  StandardStreams() = default;

  std::filesystem::path folder_;
  std::filesystem::path input_, output_;  // empty where they are no streams
};

}  // namespace moclean::cli
