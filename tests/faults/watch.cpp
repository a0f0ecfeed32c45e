#include "watch.hpp"

#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace faults {
namespace {

// The layer's own calls go past itself.
int open_past(const char* path, int flags) {
  return static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, 0600));
}

struct Error {
  const char* name;
  int number;
};
constexpr Error errors[] = {{"EACCES", EACCES}, {"EDQUOT", EDQUOT}, {"EINTR", EINTR},
                            {"EIO", EIO},       {"EMFILE", EMFILE}, {"ENOENT", ENOENT},
                            {"ENOLCK", ENOLCK}, {"ENOMEM", ENOMEM}, {"ENOSPC", ENOSPC},
                            {"EPERM", EPERM}};

[[noreturn]] void give_up(const char* why) {
  static_cast<void>(!syscall(SYS_write, 2, why, std::strlen(why)));
  _exit(99);
}

struct Settings {
  std::vector<std::string> folders;
  std::atomic<std::uint64_t> own_count = 0;
  std::atomic<std::uint64_t>* count = &own_count;
  int log = -1;
  std::uint64_t at = 0;
  int error = 0;
  bool is_short = false, kills = false, lasts = false;
  std::string module;  ///< this library

  Settings() {
    if (const char* list = std::getenv("FAULTS_FOLDERS")) split(list);
    if (const char* file = std::getenv("FAULTS_COUNT")) share(file);
    if (const char* file = std::getenv("FAULTS_LOG"))
      if (log = open_past(file, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC); log < 0)
        give_up("faults: FAULTS_LOG cannot be written\n");
    if (const char* number = std::getenv("FAULTS_AT")) at = std::strtoull(number, nullptr, 10);
    if (const char* how = std::getenv("FAULTS_HOW")) read_how(how);
    Dl_info here{};
    if (dladdr(reinterpret_cast<void*>(&give_up), &here) != 0) module = here.dli_fname;
    void* none[1];
    backtrace(none, 1);  // loads what it needs before anything is counted
  }

  void split(std::string_view list) {
    while (!list.empty()) {
      const auto end = std::min(list.find(':'), list.size());
      folders.emplace_back(list.substr(0, end));
      list.remove_prefix(std::min(end + 1, list.size()));
    }
  }

  void share(const char* file) {
    const int fd = open_past(file, O_RDWR | O_CLOEXEC);
    void* place = fd < 0
                      ? MAP_FAILED
                      : reinterpret_cast<void*>(syscall(SYS_mmap, nullptr, sizeof *count,
                                                        PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0));
    if (place == MAP_FAILED) give_up("faults: FAULTS_COUNT cannot be mapped\n");
    syscall(SYS_close, fd);
    count = static_cast<std::atomic<std::uint64_t>*>(place);
  }

  void read_how(std::string_view how) {
    if (how.ends_with("...")) lasts = true, how.remove_suffix(3);
    is_short = how == "short";
    kills = how == "kill";
    for (const Error& known : errors)
      if (how == known.name) error = known.number;
    if (!is_short && !kills && error == 0) give_up("faults: FAULTS_HOW is nothing that is known\n");
  }
};

Settings& settings() {
  static Settings* all = new Settings;  // outlives all that calls at the end of the process
  return *all;
}

std::array<std::atomic<bool>, 4096> watched_fds;

void append(std::string& line, const std::string& text) { line += text, line += '\t'; }
void append(std::string& line, std::int64_t number) { append(line, std::to_string(number)); }

std::string hexadecimal(std::string_view bytes) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  text.reserve(2 * bytes.size());
  for (const unsigned char byte : bytes) text += digits[byte >> 4], text += digits[byte & 15];
  return text;
}

/// MODULE+OFFSET of all who are in the midst of a call, without this library.
std::string callers() {
  std::array<void*, 40> frames;
  const int n = backtrace(frames.data(), static_cast<int>(frames.size()));
  std::string text;
  for (int k = 0; k < n; ++k) {
    Dl_info at{};
    if (dladdr(frames[static_cast<std::size_t>(k)], &at) == 0 || settings().module == at.dli_fname)
      continue;
    char part[300];
    const char* name = std::strrchr(at.dli_fname, '/');
    std::snprintf(part, sizeof part, "%s+%zx ", name ? name + 1 : at.dli_fname,
                  static_cast<std::size_t>(static_cast<char*>(frames[static_cast<std::size_t>(k)]) -
                                           static_cast<char*>(at.dli_fbase)));
    text += part;
  }
  return text;
}

}  // namespace

std::string path_of(int fd) {
  char name[64], target[4096];
  std::snprintf(name, sizeof name, "/proc/self/fd/%d", fd);
  const long n = syscall(SYS_readlink, name, target, sizeof target);
  return n > 0 ? std::string(target, static_cast<std::size_t>(n)) : std::string();
}

std::string absolute(int at, const char* path) {
  if (!path) return "";
  if (*path == '/') return path;
  if (at != AT_FDCWD) return path_of(at) + (*path ? "/" : "") + path;
  char here[4096];
  return (syscall(SYS_getcwd, here, sizeof here) > 0 ? std::string(here) + "/" : std::string()) +
         path;
}

bool is_watched(const std::string& path) {
  for (const std::string& folder : settings().folders)
    if (path.starts_with(folder) && (path.size() == folder.size() || path[folder.size()] == '/'))
      return true;
  return false;
}

bool is_watched(int fd) {
  return fd >= 0 && fd < static_cast<int>(watched_fds.size()) &&
         watched_fds[static_cast<std::size_t>(fd)];
}

void watch(int fd, bool watched) {
  if (fd >= static_cast<int>(watched_fds.size()))
    give_up("faults: more files are open at once than the layer can follow\n");
  if (fd >= 0) watched_fds[static_cast<std::size_t>(fd)] = watched;
}

Fate fate_of(const Call& call) {
  Settings& now = settings();
  Fate fate{++*now.count};
  const bool meant = now.at > 0 && (fate.number == now.at || (now.lasts && fate.number > now.at));
  if (!meant) return fate;
  if (now.kills) {
    log(call, {fate.number, EINTR}, -1, EINTR);
    kill(0, SIGKILL);
  }
  if (now.lasts && now.error == ENOSPC && call.kind != Kind::room) return fate;
  fate.is_short = now.is_short;
  fate.error = now.error;
  return fate;
}

void log(const Call& call, const Fate& fate, long result, int error) {
  const Settings& now = settings();
  if (now.log < 0) return;
  std::string line;
  append(line, static_cast<std::int64_t>(fate.number));
  append(line, getpid());
  append(line, std::string(call.name));
  append(line, result);
  append(line, result < 0 ? error : 0);
  append(line, fate.fails() || fate.is_short);
  append(line, call.fd);
  append(line, call.offset);
  append(line, call.flags);
  append(line, call.path);
  append(line, call.second);
  append(line,
         hexadecimal(call.bytes.substr(0, result < 0 ? 0 : static_cast<std::size_t>(result))));
  line += callers() + "\n";
  static_cast<void>(!syscall(SYS_write, now.log, line.data(), line.size()));
}

}  // namespace faults
