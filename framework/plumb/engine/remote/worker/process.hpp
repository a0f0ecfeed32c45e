#pragma once
/// A worker as its driver sees it: a fresh process at the other end of a socket.

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

/// Sends whole messages over a socket. False when the other end is gone.
bool send_message(int socket, std::string_view message);
/// The next whole message; none when the other end is gone, or at `deadline`, if one is given.
using Deadline = std::optional<std::chrono::steady_clock::time_point>;
std::optional<std::string> receive_message(int socket, Deadline deadline = std::nullopt);

/// How a process ended, for a sentence that begins with "its process": "was ended by signal 11
/// (Segmentation fault)", "exited with code 3".
struct Ending {
  std::string how;
  bool from_outside =
      false;  ///< by SIGKILL, SIGTERM, SIGINT or SIGHUP: the call need not be to blame
};

class WorkerProcess {
 public:
  /// Starts `command` anew (posix_spawn: nothing of this process's threads or memory goes along)
  /// with one end of a socket as its descriptor 3. Throws Error.
  explicit WorkerProcess(const std::vector<std::string>& command);
  ~WorkerProcess();  ///< ends it
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  int socket() const { return socket_; }
  pid_t id() const { return id_; }
  /// Ends it if it still runs, and says how it ended.
  Ending end();

  static constexpr int channel = 3;

 private:
  int socket_ = -1;
  pid_t id_ = -1;
};

}  // namespace plumb
