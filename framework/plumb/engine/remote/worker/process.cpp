#include "plumb/engine/remote/worker/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include "plumb/data/error.hpp"

extern char** environ;

namespace plumb {
namespace {

constexpr std::uint64_t longest_message = std::uint64_t{1} << 36;
constexpr std::size_t first_piece = std::size_t{1} << 20;

/// False at the deadline or when the other end is gone.
bool read_all(int socket, char* to, std::size_t size, Deadline deadline) {
  while (size > 0) {
    if (deadline) {
      // Rounded up: who is told false at the deadline finds that it has passed.
      const auto left =
          std::chrono::ceil<std::chrono::milliseconds>(*deadline - std::chrono::steady_clock::now())
              .count();
      pollfd waiting{socket, POLLIN, 0};
      const int ready = poll(&waiting, 1, static_cast<int>(std::clamp<long>(left, 0, 1 << 30)));
      if (ready < 0 && errno == EINTR) continue;
      if (ready <= 0) return false;
    }
    const ssize_t n = recv(socket, to, size, 0);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    to += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

bool write_all(int socket, const char* from, std::size_t size) {
  while (size > 0) {
    const ssize_t n = send(socket, from, size, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    from += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace

bool send_message(int socket, std::string_view message) {
  const std::uint64_t size = message.size();
  return write_all(socket, reinterpret_cast<const char*>(&size), sizeof size) &&
         write_all(socket, message.data(), message.size());
}

std::optional<std::string> receive_message(int socket, Deadline deadline) {
  std::uint64_t size = 0;
  if (!read_all(socket, reinterpret_cast<char*>(&size), sizeof size, deadline) ||
      size > longest_message)
    return std::nullopt;
  std::string message;
  while (message.size() <
         size) {  // what is announced need not come: there is room for as much again as did
    const std::size_t have = message.size();
    message.resize(std::min<std::size_t>(size, std::max(first_piece, 2 * have)));
    if (!read_all(socket, message.data() + have, message.size() - have, deadline))
      return std::nullopt;
  }
  return message;
}

WorkerProcess::WorkerProcess(const std::vector<std::string>& command) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw Error(std::string("no worker can be started: ") + std::strerror(errno));
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (ends[1] == channel)
    posix_spawn_file_actions_adddup2(&actions, ends[1],
                                     ends[1]);  // to itself: loses only close-on-exec
  else
    posix_spawn_file_actions_adddup2(&actions, ends[1], channel);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;  // signals that this process holds back, a worker does not
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  const int fault =
      posix_spawn(&id_, command.front().c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (fault != 0) {
    close(ends[0]);
    throw Error("no worker can be started (" + command.front() + "): " + std::strerror(fault));
  }
  socket_ = ends[0];
}

WorkerProcess::~WorkerProcess() { end(); }

Ending WorkerProcess::end() {
  if (id_ < 0) return {};
  int status = 0;
  pid_t gone = waitpid(id_, &status, WNOHANG);
  bool by_us = false;
  if (gone == 0) {  // its socket may have closed a moment before it is gone
    pollfd waiting{socket_, POLLIN, 0};
    if (poll(&waiting, 1, 0) == 1 && (waiting.revents & POLLHUP))
      for (int tries = 0; tries < 200 && gone == 0; ++tries)
        usleep(5000), gone = waitpid(id_, &status, WNOHANG);
  }
  if (gone == 0) {
    by_us = true;
    kill(id_, SIGKILL);
    while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
  }
  close(socket_);
  id_ = socket_ = -1;
  Ending ending;
  if (by_us)
    ending.how = "was stopped";
  else if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    ending.how = "was ended by signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
    ending.from_outside =
        signal == SIGKILL || signal == SIGTERM || signal == SIGINT || signal == SIGHUP;
  } else {
    ending.how = "exited with code " + std::to_string(WEXITSTATUS(status));
  }
  return ending;
}

}  // namespace plumb
