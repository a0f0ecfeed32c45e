#include "watch.hpp"

#include <signal.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "journal.hpp"
#include "past.hpp"

namespace faults {
namespace {

struct Error {
  const char* name;
  int number;
};
constexpr Error errors[] = {{"EACCES", EACCES}, {"EDQUOT", EDQUOT}, {"EINTR", EINTR},
                            {"EIO", EIO},       {"EMFILE", EMFILE}, {"ENOENT", ENOENT},
                            {"ENOLCK", ENOLCK}, {"ENOMEM", ENOMEM}, {"ENOSPC", ENOSPC},
                            {"EPERM", EPERM}};

struct Settings {
  std::vector<std::string> folders;
  std::atomic<std::uint64_t> own_count = 0;
  std::atomic<std::uint64_t>* count = &own_count;
  std::uint64_t at = 0;
  int error = 0;
  bool is_short = false, kills = false, lasts = false;

  Settings() {
    if (const char* list = std::getenv("FAULTS_FOLDERS")) split(list);
    if (const char* file = std::getenv("FAULTS_COUNT")) share(file);
    if (const char* number = std::getenv("FAULTS_AT")) at = std::strtoull(number, nullptr, 10);
    if (const char* how = std::getenv("FAULTS_HOW")) read_how(how);
    open_log();
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

}  // namespace faults
