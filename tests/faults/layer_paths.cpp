/// Calls on names: what they name is made, moved, removed and looked at.
#undef _FORTIFY_SOURCE
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <string>

#include "layer.hpp"

using faults::Call;
using faults::Fate;
using faults::Kind;
using faults::made;
using faults::on_path;
using faults::on_two;

// ---- making, moving, removing

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
PASSED int chmod(const char* path, mode_t mode) noexcept {
  return on_path("chmod", Kind::alter, AT_FDCWD, path, [&] { return REAL(chmod)(path, mode); });
}
