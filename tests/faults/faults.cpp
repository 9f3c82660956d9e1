// Loaded before all other libraries (LD_PRELOAD): makes one call of a function fail.
//   MOCLEAN_FAULT=NAME:N   the N-th call of NAME fails, counted from 1; NAME alone counts only
//   MOCLEAN_FAULT_CALLS=FILE   gets the number of calls at the end
// Counted are calls after the first of pthread_sigmask(), with which the program begins: what fails
// before is not the program's.

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

extern "C" void* __libc_malloc(std::size_t);  // NOLINT: dlsym() would call malloc itself

namespace {

std::atomic<bool> begun = false;
std::atomic<long> calls = 0;
char fault[32] = "";
long fails_at = 0;

struct Setting {
  Setting() {
    const char* text = std::getenv("MOCLEAN_FAULT");
    if (!text) return;
    const std::size_t length = std::strcspn(text, ":");
    std::memcpy(fault, text, length < sizeof fault ? length : 0);
    if (text[length] == ':') fails_at = std::atol(text + length + 1);
  }
  ~Setting() {
    begun = false;
    const char* file = std::getenv("MOCLEAN_FAULT_CALLS");
    if (!file) return;
    if (std::FILE* out = std::fopen(file, "w")) {
      std::fprintf(out, "%ld\n", calls.load());
      std::fclose(out);
    }
  }
} setting;

bool fails(const char* name) {
  return begun && std::strcmp(name, fault) == 0 && ++calls == fails_at;
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

int failed(int error) {
  errno = error;
  return -1;
}

}  // namespace

extern "C" {

int pthread_sigmask(int how, const sigset_t* set, sigset_t* before) {
  static auto* const real = next<int(int, const sigset_t*, sigset_t*)>("pthread_sigmask");
  begun = true;
  return real(how, set, before);
}

void* malloc(std::size_t size) {
  if (fails("malloc")) {
    errno = ENOMEM;
    return nullptr;
  }
  return __libc_malloc(size);
}

ssize_t write(int file, const void* bytes, std::size_t count) {
  static auto* const real = next<ssize_t(int, const void*, std::size_t)>("write");
  return fails("write") ? failed(ENOSPC) : real(file, bytes, count);
}

ssize_t read(int file, void* bytes, std::size_t count) {
  static auto* const real = next<ssize_t(int, void*, std::size_t)>("read");
  return fails("read") ? failed(EIO) : real(file, bytes, count);
}

int fsync(int file) {
  static auto* const real = next<int(int)>("fsync");
  return fails("fsync") ? failed(EIO) : real(file);
}

int close(int file) {
  static auto* const real = next<int(int)>("close");
  const bool fault_here = fails("close");
  const int result = real(file);  // as Linux does: it is closed whatever close() says
  return fault_here ? failed(EIO) : result;
}

int rename(const char* from, const char* to) {
  static auto* const real = next<int(const char*, const char*)>("rename");
  return fails("rename") ? failed(EACCES) : real(from, to);
}

int open(const char* path, int flags, ...) {
  static auto* const real = next<int(const char*, int, ...)>("open");
  std::va_list rest;
  va_start(rest, flags);
  const int mode = (flags & O_CREAT) != 0 ? va_arg(rest, int) : 0;
  va_end(rest);
  return fails("open") ? failed(EMFILE) : real(path, flags, mode);
}

}  // extern "C"
