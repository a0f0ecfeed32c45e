/// Calls on what is open: its bytes, its locks, what is told of it and who may use it.
#undef _FORTIFY_SOURCE
#include <dirent.h>
#include <fcntl.h>
#include <stdarg.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <string>
#include <string_view>

#include "layer.hpp"

using faults::Fate;
using faults::Kind;
using faults::on_fd;

namespace {

std::size_t less(std::size_t size, const Fate& fate) {
  return fate.is_short && size > 1 ? size / 2 : size;
}

}  // namespace

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

// ---- what is told of it

#define FSTAT(name, structure)                                                                  \
  PASSED int name(int fd, struct structure* to) noexcept {                                      \
    if (!faults::is_watched(fd)) return REAL(name)(fd, to);                                     \
    return on_fd("fstat", Kind::look, fd, -1, [&](const Fate&) { return REAL(name)(fd, to); }); \
  }
FSTAT(fstat, stat)
FSTAT(fstat64, stat64)

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

// ---- who may use it

PASSED int fchmod(int fd, mode_t mode) noexcept {
  if (!faults::is_watched(fd)) return REAL(fchmod)(fd, mode);
  return on_fd("fchmod", Kind::alter, fd, -1, [&](const Fate&) { return REAL(fchmod)(fd, mode); });
}
PASSED int fchown(int fd, uid_t owner, gid_t group) noexcept {
  if (!faults::is_watched(fd)) return REAL(fchown)(fd, owner, group);
  return on_fd("fchown", Kind::alter, fd, -1,
               [&](const Fate&) { return REAL(fchown)(fd, owner, group); });
}
