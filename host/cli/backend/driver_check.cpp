#include "cli/backend/driver_check.hpp"

#include <cstdio>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "moclean/core/error.hpp"
#include "moclean/device/device.hpp"

#include "cli/backend/kernel_cache.hpp"

namespace moclean::cli {
namespace {

namespace fs = std::filesystem;

bool can_be_listed(const fs::path& folder) {
  std::error_code error;
  const fs::directory_iterator entries(folder, error);
  return !error && entries != fs::directory_iterator();
}

// What the driver says when it ends its process is said better by us.
[[noreturn]] void ask_as_child(const std::function<void()>& ask) {
  if (const int nothing = open("/dev/null", O_WRONLY); nothing >= 0) {
    dup2(nothing, STDOUT_FILENO);
    dup2(nothing, STDERR_FILENO);
  }
  try {
    ask();
  } catch (...) {  // an error is reported by whoever asks next
  }
  _exit(0);
}

}  // namespace

void require_driver(const fs::path& cpus, const std::function<void()>& ask) {
  if (can_be_listed(cpus)) return;
  std::fflush(nullptr);  // what is buffered would be written by both
  const pid_t child = fork();
  if (child < 0) return;
  if (child == 0) ask_as_child(ask);
  int status = 0;
  if (waitpid(child, &status, 0) != child || !WIFSIGNALED(status)) return;
  throw DeviceError(fmt::format(
      "the OpenCL driver cannot start here: it ends the program (signal {}), most likely because "
      "{} cannot be read; give the container /sys (mount -t sysfs sysfs /sys; docker run -v "
      "/sys:/sys:ro), or work without OpenCL: --backend reference",
      WTERMSIG(status), cpus.string()));
}

void require_driver() {
  require_kernel_cache();
  require_driver("/sys/devices/system/cpu", [] { list_devices(); });
}

}  // namespace moclean::cli
