#include "cli/printing/standard_output.hpp"

#include <cerrno>
#include <cstdio>
#include <mutex>

#include "moclean/formats/unfinished.hpp"

namespace moclean::cli {
namespace {

// Of the process, as standard output is.
int first_failure = 0;
std::mutex first_failure_mutex;

void keep_failure(bool failed) {
  if (!failed) return;
  const int error = errno == 0 ? EIO : errno;
  const std::lock_guard lock(first_failure_mutex);
  if (first_failure == 0) first_failure = error;
}

}  // namespace

void write_output(std::string_view text) {
  const OutsideWait wait;
  errno = 0;
  keep_failure(std::fwrite(text.data(), 1, text.size(), stdout) != text.size());
}

int output_failure() {
  const OutsideWait wait;
  errno = 0;
  keep_failure(std::fflush(stdout) != 0 || std::ferror(stdout) != 0);
  const std::lock_guard lock(first_failure_mutex);
  return first_failure;
}

}  // namespace moclean::cli
