// Loaded before all other libraries (LD_PRELOAD): makes calls of a function fail.
//   MOCLEAN_FAULT=NAME:N       the N-th call of NAME fails, counted from 1; NAME alone counts only
//   MOCLEAN_FAULT=NAME:N+      every call fails from the N-th on
//   MOCLEAN_FAULT=NAME:N:HOW   with another error: `interrupted` (EINTR), or, for write(), `short`:
//   the
//                              N-th call writes half of its bytes, and those after it find no space
//   MOCLEAN_FAULT_CALLS=FILE   gets the number of calls at the end
// Counted are calls after the first of pthread_sigmask(), with which the program begins: what fails
// before is not the program's. Calls within the C library do not come here.

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

extern "C" {
void* __libc_malloc(std::size_t);                 // NOLINT: dlsym() would call malloc itself
void* __libc_calloc(std::size_t, std::size_t);    // NOLINT
void* __libc_realloc(void*, std::size_t);         // NOLINT
void* __libc_memalign(std::size_t, std::size_t);  // NOLINT
}

namespace {

std::atomic<bool> begun = false;
std::atomic<long> calls = 0;
char fault[32] = "";
long fails_at = 0;
bool lasting = false, interrupted = false, halves = false;

struct Setting {
  Setting() {
    const char* text = std::getenv("MOCLEAN_FAULT");
    if (!text) return;
    const std::size_t length = std::strcspn(text, ":");
    std::memcpy(fault, text, length < sizeof fault ? length : 0);
    if (text[length] != ':') return;
    char* rest = nullptr;
    fails_at = std::strtol(text + length + 1, &rest, 10);
    lasting = *rest == '+';
    interrupted = std::strstr(rest, ":interrupted") != nullptr;
    halves = std::strstr(rest, ":short") != nullptr;
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

bool is_fault(const char* name) { return begun && std::strcmp(name, fault) == 0; }

// The error of this call; 0 where it is none that fails.
int error_of(const char* name, int error) {
  if (!is_fault(name)) return 0;
  const long n = ++calls;
  const bool now = n == fails_at || (lasting && fails_at > 0 && n > fails_at);
  return now ? (interrupted ? EINTR : error) : 0;
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

// The function of this name, or -1 and its error. `name` is that of the fault, too.
template <class Function, class... Arguments>
auto call(const char* name, const char* real, int error, Arguments... arguments)
    -> decltype(static_cast<Function*>(nullptr)(arguments...)) {
  if (const int now = error_of(name, error)) {
    errno = now;
    return -1;
  }
  return next<Function>(real)(arguments...);
}

template <class Allocate>
void* allocated(const char* name, const Allocate& allocate) {
  if (const int now = error_of(name, ENOMEM)) {
    errno = now;
    return nullptr;
  }
  return allocate();
}

}  // namespace

extern "C" {

int pthread_sigmask(int how, const sigset_t* set, sigset_t* before) {
  static auto* const real = next<int(int, const sigset_t*, sigset_t*)>("pthread_sigmask");
  begun = true;
  return real(how, set, before);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*work)(void*),
                   void* argument) {
  static auto* const real =
      next<int(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)>("pthread_create");
  const int error = error_of("pthread_create", EAGAIN);
  return error != 0 ? error : real(thread, attributes, work, argument);
}

void* malloc(std::size_t size) {
  return allocated("malloc", [&] { return __libc_malloc(size); });
}
void* calloc(std::size_t count, std::size_t size) {
  return allocated("calloc", [&] { return __libc_calloc(count, size); });
}
void* realloc(void* memory, std::size_t size) {
  return allocated("realloc", [&] { return __libc_realloc(memory, size); });
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return allocated("aligned_alloc", [&] { return __libc_memalign(alignment, size); });
}

void* mmap(void* address, std::size_t size, int protection, int flags, int file, off_t offset) {
  static auto* const real = next<void*(void*, std::size_t, int, int, int, off_t)>("mmap");
  if (const int now = error_of("mmap", ENOMEM)) {
    errno = now;
    return MAP_FAILED;
  }
  return real(address, size, protection, flags, file, offset);
}
void* mmap64(void* address, std::size_t size, int protection, int flags, int file, off_t offset) {
  return mmap(address, size, protection, flags, file, offset);
}
int munmap(void* address, std::size_t size) {
  return call<int(void*, std::size_t)>("munmap", "munmap", EINVAL, address, size);
}

ssize_t write(int file, const void* bytes, std::size_t count) {
  static auto* const real = next<ssize_t(int, const void*, std::size_t)>("write");
  if (halves && is_fault("write")) {
    const long n = ++calls;
    if (n == fails_at && count > 1) return real(file, bytes, count / 2);
    if (n < fails_at) return real(file, bytes, count);
    errno = ENOSPC;
    return -1;
  }
  return call<ssize_t(int, const void*, std::size_t)>("write", "write", ENOSPC, file, bytes, count);
}

ssize_t writev(int file, const iovec* parts, int count) {
  return call<ssize_t(int, const iovec*, int)>("writev", "writev", ENOSPC, file, parts, count);
}

ssize_t read(int file, void* bytes, std::size_t count) {
  return call<ssize_t(int, void*, std::size_t)>("read", "read", EIO, file, bytes, count);
}

off_t lseek(int file, off_t offset, int from) {
  return call<off_t(int, off_t, int)>("lseek", "lseek", EIO, file, offset, from);
}
off_t lseek64(int file, off_t offset, int from) {
  return call<off_t(int, off_t, int)>("lseek", "lseek", EIO, file, offset, from);
}

int fsync(int file) { return call<int(int)>("fsync", "fsync", EIO, file); }

int close(int file) {
  static auto* const real = next<int(int)>("close");
  const int error = error_of("close", EIO);
  const int result = real(file);  // as Linux does: it is closed whatever close() says
  if (error == 0) return result;
  errno = error;
  return -1;
}

int rename(const char* from, const char* to) {
  return call<int(const char*, const char*)>("rename", "rename", EACCES, from, to);
}
int remove(const char* path) { return call<int(const char*)>("remove", "remove", EBUSY, path); }
int unlinkat(int folder, const char* path, int flags) {
  return call<int(int, const char*, int)>("unlinkat", "unlinkat", EBUSY, folder, path, flags);
}
int mkdir(const char* path, mode_t mode) {
  return call<int(const char*, mode_t)>("mkdir", "mkdir", ENOSPC, path, mode);
}
int truncate(const char* path, off_t size) {
  return call<int(const char*, off_t)>("truncate", "truncate", EIO, path, size);
}
int fchmod(int file, mode_t mode) {
  return call<int(int, mode_t)>("fchmod", "fchmod", EPERM, file, mode);
}
int fchown(int file, uid_t user, gid_t group) {
  return call<int(int, uid_t, gid_t)>("fchown", "fchown", EPERM, file, user, group);
}
int flock(int file, int operation) {
  return call<int(int, int)>("flock", "flock", ENOLCK, file, operation);
}

int stat(const char* path, struct stat* status) {
  return call<int(const char*, struct stat*)>("stat", "stat", EIO, path, status);
}
int lstat(const char* path, struct stat* status) {
  return call<int(const char*, struct stat*)>("stat", "lstat", EIO, path, status);
}
int fstat(int file, struct stat* status) {
  return call<int(int, struct stat*)>("fstat", "fstat", EIO, file, status);
}

dirent* readdir(DIR* folder) {
  static auto* const real = next<dirent*(DIR*)>("readdir");
  const int error = error_of("readdir", EIO);
  if (error == 0) return real(folder);
  errno = error;
  return nullptr;
}

int open(const char* path, int flags, ...) {
  std::va_list rest;
  va_start(rest, flags);
  const int mode = (flags & O_CREAT) != 0 ? va_arg(rest, int) : 0;
  va_end(rest);
  return call<int(const char*, int, ...)>("open", "open", EMFILE, path, flags, mode);
}

int openat(int folder, const char* path, int flags, ...) {
  std::va_list rest;
  va_start(rest, flags);
  const int mode = (flags & O_CREAT) != 0 ? va_arg(rest, int) : 0;
  va_end(rest);
  return call<int(int, const char*, int, ...)>("openat", "openat", EMFILE, folder, path, flags,
                                               mode);
}

}  // extern "C"
