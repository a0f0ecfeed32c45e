#include "plumb/engine/remote/worker/service.hpp"

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <unistd.h>

#include <thread>

#include "plumb/data/archive.hpp"
#include "plumb/engine/remote/worker/process.hpp"
#include "plumb/engine/remote/worker/task.hpp"

namespace plumb {
namespace {

TEST(Worker, ThatCannotBeginTellsItsDriverForEachCallAndEndsWithIt) {
  int ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
  std::thread worker([&] { refuse_calls(ends[1], "its store is gone"); });
  for (const std::uint64_t item : {0, 7}) {
    ASSERT_TRUE(send_message(ends[0], to_bytes(Request{"an image", item, 1, {}})));
    const auto message = receive_message(ends[0]);
    ASSERT_TRUE(message);
    const auto reply = from_bytes<Reply>(*message);
    EXPECT_EQ(reply.item, item);
    EXPECT_EQ(reply.fault, "a worker cannot begin: its store is gone");
    EXPECT_TRUE(reply.machinery && !reply.crashed);
  }
  close(ends[0]);
  worker.join();
  close(ends[1]);
}

}  // namespace
}  // namespace plumb
