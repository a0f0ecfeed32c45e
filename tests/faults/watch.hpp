#pragma once
/// Which calls are counted, and which of them fails: said by the driver in the environment.
///
/// - FAULTS_FOLDERS: folders, with ':' between them; calls on what lies in them count
/// - FAULTS_COUNT: a file of 8 bytes, the number of calls so far; processes that inherit it count
///   together
/// - FAULTS_AT: the number of the call that fails, from 1; none fails without it
/// - FAULTS_HOW: the name of an error (ENOSPC), `short` (half of the bytes), `kill` (SIGKILL to all
///   of the process group), or an error with `...` behind it: that call and all that follow; of
///   ENOSPC... only those that need room

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace faults {

/// What a call does, for those who fail it.
enum class Kind {
  look,   ///< tells something: stat, open for reading, read, readdir
  alter,  ///< changes something and needs no room: unlink, close, sync
  room,   ///< needs room on the disk: write, open with O_CREAT, mkdir, rename
};

/// One call, as it stands in the log.
struct Call {
  const char* name;
  Kind kind = Kind::look;
  int fd = -1;
  std::string path = {}, second = {};
  std::int64_t offset = 0;
  int flags = 0;
  std::string_view bytes = {};  ///< what it writes
};

/// What is to become of a call.
struct Fate {
  std::uint64_t number = 0;
  int error = 0;          ///< 0: it is made
  bool is_short = false;  ///< with half of its bytes
  bool fails() const { return error != 0; }
};

/// `path`, seen from the folder that `at` (AT_FDCWD) is.
std::string absolute(int at, const char* path);
bool is_watched(const std::string& path);
/// Of a descriptor: whether it belongs to a path that counts.
bool is_watched(int fd);
void watch(int fd, bool watched);
std::string path_of(int fd);

/// Counts a call and says what is to become of it; does not return from one that kills.
Fate fate_of(const Call& call);

}  // namespace faults
