#include <sys/socket.h>
#include <unistd.h>

#include "../fuzz.hpp"
#include "plumb/engine/remote/slurm/job_folder.hpp"
#include "plumb/engine/remote/worker/image.hpp"
#include "plumb/engine/remote/worker/process.hpp"
#include "plumb/engine/remote/worker/task.hpp"

using namespace plumb;

namespace {

template <class T>
void read(std::string_view bytes) {
  const std::string written = to_bytes(from_bytes<T>(bytes));
  fuzz::require(to_bytes(from_bytes<T>(written)) == written,
                "a message that was read is the same after it was written");
}

std::optional<std::string> received(std::string_view bytes) {
  int ends[2];
  fuzz::require(socketpair(AF_UNIX, SOCK_STREAM, 0, ends) == 0, "there are sockets");
  const bool sent = send(ends[0], bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL) ==
                    static_cast<ssize_t>(bytes.size());
  ::close(ends[0]);
  const auto message = sent ? receive_message(ends[1]) : std::nullopt;
  ::close(ends[1]);
  return message;
}

}  // namespace

/// The first byte says which message the others are.
PLUMB_FUZZ_READER(message) {
  if (bytes.empty()) throw Error("no message");
  const std::string_view rest = bytes.substr(1);
  switch (bytes[0]) {
    case 'Q':
      return read<Request>(rest);
    case 'A':
      return read<Reply>(rest);
    case 'I':
      return read<Image>(rest);
    case 'T':
      return read<Task>(rest);
    case 'N':
      return read<Notice>(rest);
    default:
      if (const auto message = received(rest)) read<Reply>(*message);
  }
}
