#pragma once
/// What the layer does for itself, past its own functions: nothing of it is counted.

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstring>

namespace faults {

inline int open_past(const char* path, int flags) {
  return static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, 0600));
}

[[noreturn]] inline void give_up(const char* why) {
  static_cast<void>(!syscall(SYS_write, 2, why, std::strlen(why)));
  _exit(99);
}

}  // namespace faults
