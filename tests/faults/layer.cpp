/// The calls of the C library on files and folders, as LD_PRELOAD puts them before the real ones
/// (watch.hpp says what becomes of each).
///
/// fsync and its like are counted, and nothing more: what a power cut would leave is worked out
/// from the log (power.py), and the disk has its peace. What the C library calls inside of itself
/// does not come by here (fwrite, dlopen); audit.py holds what strace sees against the log.
#undef _FORTIFY_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <vector>

#include "watch.hpp"

using faults::Call;
using faults::Fate;
using faults::Kind;

#define PASSED extern "C" __attribute__((visibility("default")))
/// The function of that name behind this library.
#define REAL(name) real<decltype(&::name)>(#name)

namespace {

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

enum class Failing { instead, behind };  ///< what fails is not done, or done nevertheless: a close

/// Counts a call, makes it unless it is to fail, and logs it.
template <class Result, class Action>
Result made(const Call& call, Result bad, Action action, Failing failing = Failing::instead) {
  const Fate fate = faults::fate_of(call);
  Result result = bad;
  if (!fate.fails() || failing == Failing::behind) result = action(fate);
  int error = errno;
  if (fate.fails()) result = bad, error = fate.error;
  long told = 0;
  if constexpr (std::is_pointer_v<Result>)
    told = result == bad ? -1 : 0;
  else
    told = static_cast<long>(result);
  faults::log(call, fate, told, error);
  errno = error;
  return result;
}

template <class Action>
int on_path(const char* name, Kind kind, int at, const char* path, Action action, int flags = 0) {
  const std::string place = faults::absolute(at, path);
  if (!faults::is_watched(place)) return action();
  return made(Call{name, kind, -1, place, {}, 0, flags}, -1, [&](const Fate&) { return action(); });
}

template <class Action>
int on_two(const char* name, int at, const char* path, int second_at, const char* second,
           Action action, int flags = 0) {
  const std::string from = faults::absolute(at, path), to = faults::absolute(second_at, second);
  if (!faults::is_watched(from) && !faults::is_watched(to)) return action();
  return made(Call{name, Kind::room, -1, from, to, 0, flags}, -1,
              [&](const Fate&) { return action(); });
}

template <class Result, class Action>
Result on_fd(const char* name, Kind kind, int fd, Result bad, Action action,
             std::int64_t offset = 0, std::string_view bytes = {}, int flags = 0) {
  return made(Call{name, kind, fd, faults::path_of(fd), {}, offset, flags, bytes}, bad, action);
}

template <class Action>
int opened(const char* name, int at, const char* path, int flags, Action action) {
  const std::string place = faults::absolute(at, path);
  if (!faults::is_watched(place)) {
    const int fd = action();
    faults::watch(fd, false);
    return fd;
  }
  const Kind kind = flags & O_CREAT ? Kind::room : Kind::look;
  const int fd =
      made(Call{name, kind, -1, place, {}, 0, flags}, -1, [&](const Fate&) { return action(); });
  faults::watch(fd, true);
  return fd;
}

std::size_t less(std::size_t size, const Fate& fate) {
  return fate.is_short && size > 1 ? size / 2 : size;
}

int flags_of(const char* mode) {
  const std::string_view text = mode;
  const bool both = text.find('+') != text.npos;
  if (text.starts_with('r')) return both ? O_RDWR : O_RDONLY;
  return (both ? O_RDWR : O_WRONLY) | O_CREAT | (text.starts_with('w') ? O_TRUNC : O_APPEND);
}

template <class Action>
FILE* opened_stream(const char* path, const char* mode, Action action) {
  const std::string place = faults::absolute(AT_FDCWD, path);
  FILE* stream = nullptr;
  if (!faults::is_watched(place)) {
    stream = action();
    if (stream) faults::watch(fileno(stream), false);
    return stream;
  }
  // Its number is part of the log, and is known only when it is open.
  const int flags = flags_of(mode);
  made(Call{"open", flags & O_CREAT ? Kind::room : Kind::look, -1, place, {}, 0, flags}, -1,
       [&](const Fate&) {
         stream = action();
         return stream ? fileno(stream) : -1;
       });
  if (stream) faults::watch(fileno(stream), true);
  return stream;
}

mode_t mode_of(int flags, va_list rest) {
  return flags & (O_CREAT | __O_TMPFILE) ? va_arg(rest, mode_t) : 0;
}

}  // namespace

// ---- opening and closing

#define OPEN(name)                                                                               \
  PASSED int name(const char* path, int flags, ...) {                                            \
    va_list rest;                                                                                \
    va_start(rest, flags);                                                                       \
    const mode_t mode = mode_of(flags, rest);                                                    \
    va_end(rest);                                                                                \
    return opened("open", AT_FDCWD, path, flags, [&] { return REAL(name)(path, flags, mode); }); \
  }
OPEN(open)
OPEN(open64)

#define OPENAT(name)                                                                           \
  PASSED int name(int at, const char* path, int flags, ...) {                                  \
    va_list rest;                                                                              \
    va_start(rest, flags);                                                                     \
    const mode_t mode = mode_of(flags, rest);                                                  \
    va_end(rest);                                                                              \
    return opened("open", at, path, flags, [&] { return REAL(name)(at, path, flags, mode); }); \
  }
OPENAT(openat)
OPENAT(openat64)

PASSED int creat(const char* path, mode_t mode) {
  return opened("open", AT_FDCWD, path, O_CREAT | O_WRONLY | O_TRUNC,
                [&] { return REAL(creat)(path, mode); });
}
PASSED FILE* fopen(const char* path, const char* mode) {
  return opened_stream(path, mode, [&] { return REAL(fopen)(path, mode); });
}
PASSED FILE* fopen64(const char* path, const char* mode) {
  return opened_stream(path, mode, [&] { return REAL(fopen64)(path, mode); });
}

/// A template becomes a name when the file is there, so that the log has the name.
#define TEMPORARY(name, parameters, arguments)                                  \
  PASSED int name parameters {                                                  \
    const std::string place = faults::absolute(AT_FDCWD, path);                 \
    if (!faults::is_watched(place)) return REAL(name) arguments;                \
    Call call{"open", Kind::room, -1, place, {}, 0, O_CREAT | O_EXCL | O_RDWR}; \
    const Fate fate = faults::fate_of(call);                                    \
    const int fd = fate.fails() ? -1 : REAL(name) arguments,                    \
              error = fate.fails() ? fate.error : errno;                        \
    call.path = faults::absolute(AT_FDCWD, path);                               \
    faults::watch(fd, true);                                                    \
    faults::log(call, fate, fd, error);                                         \
    errno = error;                                                              \
    return fd;                                                                  \
  }
TEMPORARY(mkstemp, (char* path), (path))
TEMPORARY(mkstemp64, (char* path), (path))
TEMPORARY(mkostemp, (char* path, int flags), (path, flags))
TEMPORARY(mkostemp64, (char* path, int flags), (path, flags))

PASSED char* mkdtemp(char* path) {
  Call call{"mkdir", Kind::room, -1, faults::absolute(AT_FDCWD, path)};
  if (!faults::is_watched(call.path)) return REAL(mkdtemp)(path);
  const Fate fate = faults::fate_of(call);
  char* const done = fate.fails() ? nullptr : REAL(mkdtemp)(path);
  const int error = fate.fails() ? fate.error : errno;
  call.path = faults::absolute(AT_FDCWD, path);
  faults::log(call, fate, done ? 0 : -1, error);
  errno = error;
  return done;
}

PASSED int close(int fd) {
  if (!faults::is_watched(fd)) return REAL(close)(fd);
  faults::watch(fd, false);
  return made(
      Call{"close", Kind::alter, fd, faults::path_of(fd)}, -1,
      [&](const Fate&) { return REAL(close)(fd); }, Failing::behind);
}
PASSED int fclose(FILE* stream) {
  const int fd = fileno(stream);
  if (!faults::is_watched(fd)) return REAL(fclose)(stream);
  faults::watch(fd, false);
  return made(
      Call{"close", Kind::alter, fd, faults::path_of(fd)}, EOF,
      [&](const Fate&) { return REAL(fclose)(stream); }, Failing::behind);
}

// ---- bytes

#define READ(name, parameters, size, arguments)                               \
  PASSED ssize_t name parameters {                                            \
    if (!faults::is_watched(fd)) return REAL(name) arguments;                 \
    return on_fd("read", Kind::look, fd, ssize_t{-1}, [&](const Fate& fate) { \
      size = less(size, fate);                                                \
      return REAL(name) arguments;                                            \
    });                                                                       \
  }
READ(read, (int fd, void* to, size_t size), size, (fd, to, size))
READ(pread, (int fd, void* to, size_t size, off_t at), size, (fd, to, size, at))
READ(pread64, (int fd, void* to, size_t size, off64_t at), size, (fd, to, size, at))

PASSED ssize_t write(int fd, const void* from, size_t size) {
  if (!faults::is_watched(fd)) return REAL(write)(fd, from, size);
  const std::string_view bytes(static_cast<const char*>(from), size);
  const auto action = [&](const Fate& fate) { return REAL(write)(fd, from, less(size, fate)); };
  return on_fd("write", Kind::room, fd, ssize_t{-1}, action, lseek(fd, 0, SEEK_CUR), bytes);
}
PASSED ssize_t writev(int fd, const struct iovec* parts, int count) {
  if (!faults::is_watched(fd)) return REAL(writev)(fd, parts, count);
  std::string bytes;
  for (int k = 0; k < count; ++k)
    bytes.append(static_cast<const char*>(parts[k].iov_base), parts[k].iov_len);
  const auto action = [&](const Fate& fate) {
    return REAL(write)(fd, bytes.data(), less(bytes.size(), fate));
  };
  return on_fd("write", Kind::room, fd, ssize_t{-1}, action, lseek(fd, 0, SEEK_CUR), bytes);
}
#define PWRITE(name, offset)                                                                      \
  PASSED ssize_t name(int fd, const void* from, size_t size, offset at) {                         \
    if (!faults::is_watched(fd)) return REAL(name)(fd, from, size, at);                           \
    const std::string_view bytes(static_cast<const char*>(from), size);                           \
    return on_fd(                                                                                 \
        "write", Kind::room, fd, ssize_t{-1},                                                     \
        [&](const Fate& fate) { return REAL(name)(fd, from, less(size, fate), at); }, at, bytes); \
  }
PWRITE(pwrite, off_t)
PWRITE(pwrite64, off64_t)

#define FTRUNCATE(name, offset)                                                              \
  PASSED int name(int fd, offset size) noexcept {                                            \
    if (!faults::is_watched(fd)) return REAL(name)(fd, size);                                \
    return on_fd(                                                                            \
        "ftruncate", Kind::alter, fd, -1, [&](const Fate&) { return REAL(name)(fd, size); }, \
        size);                                                                               \
  }
FTRUNCATE(ftruncate, off_t)
FTRUNCATE(ftruncate64, off64_t)

#define MMAP(name, offset)                                                                         \
  PASSED void* name(void* place, size_t size, int protection, int flags, int fd,                   \
                    offset at) noexcept {                                                          \
    if (!faults::is_watched(fd)) return REAL(name)(place, size, protection, flags, fd, at);        \
    return on_fd("mmap", Kind::look, fd, MAP_FAILED,                                               \
                 [&](const Fate&) { return REAL(name)(place, size, protection, flags, fd, at); }); \
  }
MMAP(mmap, off_t)
MMAP(mmap64, off64_t)

#define SYNC(name, parameters, fd)                                            \
  PASSED int name parameters {                                                \
    if (!faults::is_watched(fd)) return REAL(name)(fd);                       \
    return on_fd(#name, Kind::alter, fd, -1, [&](const Fate&) { return 0; }); \
  }
SYNC(fsync, (int fd), fd)
SYNC(fdatasync, (int fd), fd)
SYNC(syncfs, (int fd) noexcept, fd)

// ---- locks

PASSED int flock(int fd, int how) noexcept {
  if (!faults::is_watched(fd)) return REAL(flock)(fd, how);
  return on_fd(
      "flock", Kind::look, fd, -1, [&](const Fate&) { return REAL(flock)(fd, how); }, 0, {}, how);
}

#define FCNTL(name)                                                                              \
  PASSED int name(int fd, int what, ...) {                                                       \
    va_list rest;                                                                                \
    va_start(rest, what);                                                                        \
    void* const value = va_arg(rest, void*);                                                     \
    va_end(rest);                                                                                \
    const bool locks =                                                                           \
        what == F_SETLK || what == F_SETLKW || what == F_OFD_SETLK || what == F_OFD_SETLKW;      \
    if (locks && faults::is_watched(fd))                                                         \
      return on_fd("fcntl", Kind::look, fd, -1,                                                  \
                   [&](const Fate&) { return REAL(name)(fd, what, value); });                    \
    const int done = REAL(name)(fd, what, value);                                                \
    if (what == F_DUPFD || what == F_DUPFD_CLOEXEC) faults::watch(done, faults::is_watched(fd)); \
    return done;                                                                                 \
  }
FCNTL(fcntl)
FCNTL(fcntl64)

// ---- names

PASSED int mkdir(const char* path, mode_t mode) noexcept {
  return on_path("mkdir", Kind::room, AT_FDCWD, path, [&] { return REAL(mkdir)(path, mode); });
}
PASSED int mkdirat(int at, const char* path, mode_t mode) noexcept {
  return on_path("mkdir", Kind::room, at, path, [&] { return REAL(mkdirat)(at, path, mode); });
}
PASSED int unlink(const char* path) noexcept {
  return on_path("unlink", Kind::alter, AT_FDCWD, path, [&] { return REAL(unlink)(path); });
}
PASSED int rmdir(const char* path) noexcept {
  return on_path("rmdir", Kind::alter, AT_FDCWD, path, [&] { return REAL(rmdir)(path); });
}
PASSED int remove(const char* path) noexcept {
  return on_path("remove", Kind::alter, AT_FDCWD, path, [&] { return REAL(remove)(path); });
}
PASSED int unlinkat(int at, const char* path, int flags) noexcept {
  return on_path(flags & AT_REMOVEDIR ? "rmdir" : "unlink", Kind::alter, at, path,
                 [&] { return REAL(unlinkat)(at, path, flags); });
}
PASSED int rename(const char* path, const char* to) noexcept {
  return on_two("rename", AT_FDCWD, path, AT_FDCWD, to, [&] { return REAL(rename)(path, to); });
}
PASSED int renameat(int at, const char* path, int to_at, const char* to) noexcept {
  return on_two("rename", at, path, to_at, to, [&] { return REAL(renameat)(at, path, to_at, to); });
}
PASSED int renameat2(int at, const char* path, int to_at, const char* to, unsigned flags) noexcept {
  return on_two(
      "rename", at, path, to_at, to, [&] { return REAL(renameat2)(at, path, to_at, to, flags); },
      static_cast<int>(flags));
}
PASSED int link(const char* path, const char* to) noexcept {
  return on_two("link", AT_FDCWD, path, AT_FDCWD, to, [&] { return REAL(link)(path, to); });
}
PASSED int linkat(int at, const char* path, int to_at, const char* to, int flags) noexcept {
  return on_two("link", at, path, to_at, to,
                [&] { return REAL(linkat)(at, path, to_at, to, flags); });
}
PASSED int symlink(const char* target, const char* path) noexcept {
  return on_path("symlink", Kind::room, AT_FDCWD, path,
                 [&] { return REAL(symlink)(target, path); });
}
PASSED int symlinkat(const char* target, int at, const char* path) noexcept {
  return on_path("symlink", Kind::room, at, path,
                 [&] { return REAL(symlinkat)(target, at, path); });
}

/// renameat2 of systems whose C library has no function for it; all others pass.
PASSED long syscall(long number, ...) noexcept {
  va_list rest;
  va_start(rest, number);
  long a[6];
  for (long& argument : a) argument = va_arg(rest, long);
  va_end(rest);
  const auto pass = [&] { return REAL(syscall)(number, a[0], a[1], a[2], a[3], a[4], a[5]); };
  if (number != SYS_renameat2) return pass();
  return on_two(
      "rename", static_cast<int>(a[0]), reinterpret_cast<const char*>(a[1]), static_cast<int>(a[2]),
      reinterpret_cast<const char*>(a[3]), [&] { return static_cast<int>(pass()); },
      static_cast<int>(a[4]));
}

// ---- looking

#define STAT(name, structure)                                                                 \
  PASSED int name(const char* path, struct structure* to) noexcept {                          \
    return on_path("stat", Kind::look, AT_FDCWD, path, [&] { return REAL(name)(path, to); }); \
  }
STAT(stat, stat)
STAT(stat64, stat64)
STAT(lstat, stat)
STAT(lstat64, stat64)

#define FSTAT(name, structure)                                                                  \
  PASSED int name(int fd, struct structure* to) noexcept {                                      \
    if (!faults::is_watched(fd)) return REAL(name)(fd, to);                                     \
    return on_fd("fstat", Kind::look, fd, -1, [&](const Fate&) { return REAL(name)(fd, to); }); \
  }
FSTAT(fstat, stat)
FSTAT(fstat64, stat64)

#define FSTATAT(name, structure)                                                                   \
  PASSED int name(int at, const char* path, struct structure* to, int flags) noexcept {            \
    return on_path("stat", Kind::look, at, path, [&] { return REAL(name)(at, path, to, flags); }); \
  }
FSTATAT(fstatat, stat)
FSTATAT(fstatat64, stat64)

PASSED int statx(int at, const char* path, int flags, unsigned mask, struct statx* to) noexcept {
  return on_path("stat", Kind::look, at, path,
                 [&] { return REAL(statx)(at, path, flags, mask, to); });
}
PASSED int access(const char* path, int how) noexcept {
  return on_path("access", Kind::look, AT_FDCWD, path, [&] { return REAL(access)(path, how); });
}
PASSED int faccessat(int at, const char* path, int how, int flags) noexcept {
  return on_path("access", Kind::look, at, path,
                 [&] { return REAL(faccessat)(at, path, how, flags); });
}
PASSED int statvfs(const char* path, struct statvfs* to) noexcept {
  return on_path("statvfs", Kind::look, AT_FDCWD, path, [&] { return REAL(statvfs)(path, to); });
}
PASSED ssize_t readlink(const char* path, char* to, size_t size) noexcept {
  return on_path("readlink", Kind::look, AT_FDCWD, path,
                 [&] { return static_cast<int>(REAL(readlink)(path, to, size)); });
}
PASSED char* realpath(const char* path, char* to) noexcept {
  const std::string place = faults::absolute(AT_FDCWD, path);
  if (!faults::is_watched(place)) return REAL(realpath)(path, to);
  return made(Call{"realpath", Kind::look, -1, place}, static_cast<char*>(nullptr),
              [&](const Fate&) { return REAL(realpath)(path, to); });
}
PASSED int fchmod(int fd, mode_t mode) noexcept {
  if (!faults::is_watched(fd)) return REAL(fchmod)(fd, mode);
  return on_fd("fchmod", Kind::alter, fd, -1, [&](const Fate&) { return REAL(fchmod)(fd, mode); });
}
PASSED int fchown(int fd, uid_t owner, gid_t group) noexcept {
  if (!faults::is_watched(fd)) return REAL(fchown)(fd, owner, group);
  return on_fd("fchown", Kind::alter, fd, -1,
               [&](const Fate&) { return REAL(fchown)(fd, owner, group); });
}
PASSED int chmod(const char* path, mode_t mode) noexcept {
  return on_path("chmod", Kind::alter, AT_FDCWD, path, [&] { return REAL(chmod)(path, mode); });
}

// ---- folders

PASSED DIR* opendir(const char* path) {
  const std::string place = faults::absolute(AT_FDCWD, path);
  if (!faults::is_watched(place)) return REAL(opendir)(path);
  DIR* const folder = made(Call{"opendir", Kind::look, -1, place}, static_cast<DIR*>(nullptr),
                           [&](const Fate&) { return REAL(opendir)(path); });
  if (folder) faults::watch(dirfd(folder), true);
  return folder;
}
PASSED int closedir(DIR* folder) {
  const int fd = dirfd(folder);
  if (!faults::is_watched(fd)) return REAL(closedir)(folder);
  faults::watch(fd, false);
  return made(
      Call{"close", Kind::alter, fd, faults::path_of(fd)}, -1,
      [&](const Fate&) { return REAL(closedir)(folder); }, Failing::behind);
}
#define READDIR(name, structure)                                   \
  PASSED struct structure* name(DIR* folder) {                     \
    const int fd = dirfd(folder);                                  \
    if (!faults::is_watched(fd)) return REAL(name)(folder);        \
    const auto none = static_cast<struct structure*>(nullptr);     \
    return on_fd("readdir", Kind::look, fd, none,                  \
                 [&](const Fate&) { return REAL(name)(folder); }); \
  }
READDIR(readdir, dirent)
READDIR(readdir64, dirent64)
