#include "plumb/engine/remote/worker/service.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>

#include "plumb/data/error.hpp"
#include "plumb/engine/remote/worker/image.hpp"
#include "plumb/engine/remote/worker/process.hpp"
#include "plumb/engine/remote/worker/task.hpp"
#include "plumb/engine/run/item_context.hpp"
#include "plumb/engine/run/local_executor.hpp"
#include "plumb/engine/run/parallel.hpp"

namespace plumb {
namespace {

/// A worker whose driver is gone has nobody to work for, also in the middle of a call.
void end_with_driver(int socket) {
  std::thread([socket] {
    for (;;) {
      pollfd waiting{socket, POLLRDHUP, 0};
      if (poll(&waiting, 1, -1) > 0 && (waiting.revents & (POLLRDHUP | POLLHUP | POLLERR)))
        _exit(0);
    }
  }).detach();
}

/// An eighth of what the process may allocate: the rest is for the call.
std::size_t memory_for_results(std::size_t memory) {
  constexpr std::size_t most = std::size_t{256} << 20;
  return memory > 0 ? std::min(most, memory / 8) : most;
}

class Service {
 public:
  Service(const Registry& registry, Store& store, std::size_t memory)
      : registry_(registry), books_(silent_), results_(&store, false, memory_for_results(memory)) {}

  Reply answer(const Request& request) {
    Reply reply;
    reply.item = request.item;
    reply.process = static_cast<std::uint64_t>(getpid());
    books_.clear();
    reply_ = &reply;
    const auto begin = std::chrono::steady_clock::now();
    with_threads(static_cast<unsigned>(request.threads), [&] {
      try {
        if (!request.image.empty()) take(request.image);
        if (!runs_) throw MachineryError(fault_);
        const Stopwatch watch(books_, runs_->target().plan().path);
        runs_->target().make_one(request.item, request.key, reply);
      } catch (const MachineryError& e) {
        reply.fault = e.what();
        reply.machinery = true;
      } catch (const std::exception& e) {
        reply.fault = e.what();
      }
    });
    reply.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    reply.warnings = books_.warnings();
    for (const StepTime& time : books_.times())
      reply.spent.push_back({time.path, time.cpu_seconds});
    return reply;
  }

 private:
  void take(const std::string& bytes) {
    runs_.reset();
    const RunState state{books_,
                         results_,
                         executor_,
                         -1,
                         nullptr,
                         [this](const StepRun& run, std::size_t output, std::size_t item,
                                const StoredResult& said) { passed(run, output, item, said); }};
    try {
      runs_.emplace(from_bytes<Image>(bytes), registry_, state, opened_);
    } catch (const std::exception& e) {
      fault_ = std::string("a worker cannot take up the step's inputs: ") + e.what();
      throw MachineryError(fault_);
    }
  }

  void passed(const StepRun& run, std::size_t output, std::size_t item, const StoredResult& said) {
    if (said.counts.empty()) return;
    PassedCounts counts{run_index(run), output, item, {}};
    for (const auto& [what, n] : said.counts) counts.counts.push_back({what, n});
    const std::lock_guard lock(mutex_);
    reply_->passed.push_back(std::move(counts));
  }

  std::uint64_t run_index(const StepRun& run) const {
    return static_cast<std::uint64_t>(runs_->index_of(run));
  }

  const Registry& registry_;
  Observers silent_;
  Bookkeeping books_;
  Results results_;
  LocalExecutor executor_{0};  ///< of sources that are opened again
  ImageRuns::Opened opened_;
  std::optional<ImageRuns> runs_;
  std::string fault_ = "a call came before its image";
  Reply* reply_ = nullptr;
  std::mutex mutex_;
};

}  // namespace

void refuse_calls(int socket, const std::string& why) {
  while (const auto message = receive_message(socket)) {
    Reply reply;
    reply.item = from_bytes<Request>(*message).item;
    reply.process = static_cast<std::uint64_t>(getpid());
    reply.fault = "a worker cannot begin: " + why;
    reply.machinery = true;
    if (!send_message(socket, to_bytes(reply))) return;
  }
}

void serve_calls(int socket, const Registry& registry, Store& store, std::size_t memory) {
  if (memory > 0) {
    const rlimit limit{memory, memory};
    setrlimit(RLIMIT_DATA, &limit);
  }
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);  // a crash costs its item, not the disk
  fcntl(socket, F_SETFD,
        FD_CLOEXEC);  // a program that a module starts must not keep the socket open
  end_with_driver(socket);
  Service service(registry, store, memory);
  while (const auto message = receive_message(socket))
    if (!send_message(socket, to_bytes(service.answer(from_bytes<Request>(*message))))) return;
}

}  // namespace plumb
