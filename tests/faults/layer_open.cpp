/// Calls that open and close files and folders.
#undef _FORTIFY_SOURCE
#include <dirent.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <string_view>

#include "layer.hpp"

using faults::Call;
using faults::Failing;
using faults::Fate;
using faults::Kind;
using faults::made;

namespace {

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
