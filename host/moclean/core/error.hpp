#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace moclean {

/// Base of everything the library throws on purpose. `what()` is one complete message for the user:
/// what went wrong, where, and what was expected. It never needs a prefix to be understood.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A parameter outside its valid range, or a specification string that cannot be parsed.
class ArgumentError : public Error {
 public:
  using Error::Error;
};

/// Matrices, clips or segments whose sizes do not fit together, or data a method cannot take (NaN).
class ShapeError : public Error {
 public:
  using Error::Error;
};

/// One of several takes that a method cannot take. The message names its place, `take 2: problem`;
/// who knows a better name, that of its file, has the problem alone.
class TakeError : public ShapeError {
 public:
  TakeError(std::size_t take, const std::string& problem)
      : ShapeError(std::string("take ").append(std::to_string(take)).append(": ").append(problem)),
        take_(take),
        problem_(problem) {}

  std::size_t take() const { return take_; }  ///< among those that were given, from 0
  const std::string& problem() const { return problem_; }

 private:
  std::size_t take_;
  std::string problem_;
};

/// An OpenCL device that is missing, lacks a capability, or reported a failure.
class DeviceError : public Error {
 public:
  using Error::Error;
};

/// The caller asked the running computation to stop; nothing was produced.
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

/// A file that cannot be read, parsed or written. The message reads `path:line: problem`,
/// or `path: problem` where a line makes no sense (binary files, missing files).
class FileError : public Error {
 public:
  FileError(const std::filesystem::path& file, const std::string& problem)
      : Error(file.string() + ": " + problem) {}

  /// `line` counts from 1.
  FileError(const std::filesystem::path& file, std::size_t line, const std::string& problem)
      : Error(file.string() + ":" + std::to_string(line) + ": " + problem) {}
};

}  // namespace moclean
