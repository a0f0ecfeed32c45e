#include "plumb/engine/remote/worker/pool.hpp"

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include "plumb/data/error.hpp"
#include "plumb/data/short_number.hpp"

namespace plumb {

WorkerPool::WorkerPool(WorkerOptions options)
    : options_(std::move(options)), workers_(options_.workers), images_(options_.workers, 0) {}

WorkerPool::~WorkerPool() = default;

namespace {

/// None when it is no reply to this call: a module may have written over anything.
std::optional<Reply> read_reply(const std::string& answer, const Call& call) {
  try {
    Reply reply = from_bytes<Reply>(answer);
    if (reply.item == call.item) return reply;
  } catch (const Error&) {
  }
  return std::nullopt;
}

}  // namespace

Reply WorkerPool::ask(std::unique_ptr<WorkerProcess>& worker, std::uint64_t& has, const Task& task,
                      const Call& call) {
  for (int attempt = 1;; ++attempt) {
    if (!worker) worker = std::make_unique<WorkerProcess>(options_.command), has = 0;
    Request request;
    if (has != task_) request.image = task.image;
    request.item = call.item;
    request.threads = task.threads;
    request.key = call.key;
    const auto begin = std::chrono::steady_clock::now();
    Deadline deadline;
    if (options_.time_limit)
      deadline = begin + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                             std::chrono::duration<double>(*options_.time_limit));
    std::optional<std::string> answer;
    if (send_message(worker->socket(), to_bytes(request)))
      answer = receive_message(worker->socket(), deadline);
    if (auto reply = answer ? read_reply(*answer, call) : std::nullopt) {
      has = task_;
      return *reply;
    }
    const bool late = deadline && std::chrono::steady_clock::now() >= *deadline;
    Reply reply;
    reply.item = call.item;
    reply.process = static_cast<std::uint64_t>(worker->id());
    reply.crashed = true;
    reply.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const Ending ending = worker->end();
    worker.reset();
    reply.outside = !late && ending.from_outside;
    if (late)
      reply.fault = call.title + ": took longer than the time limit of " +
                    short_number(*options_.time_limit) +
                    " s (--time-limit); its process was stopped";
    else if (answer)
      reply.fault = call.title + ": its process gave an answer that cannot be read";
    else
      reply.fault = call.title + ": its process " + ending.how;
    if (late || !ending.from_outside || attempt >= options_.tries) return reply;
  }
}

void WorkerPool::make(const Task& task, const std::function<void(const Reply&)>& done,
                      const std::function<bool(std::size_t)>& begins) {
  const std::lock_guard one_task(mutex_);
  ++task_;
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto serve = [&](std::size_t slot) {
    for (std::size_t c = next++; c < task.calls.size(); c = next++) try {
        if (!begins(task.calls[c].item)) {
          next = task.calls.size();
          return;
        }
        const Reply reply = ask(workers_[slot], images_[slot], task, task.calls[c]);
        const std::lock_guard lock(mutex);
        if (failure) return;
        done(reply);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = task.calls.size();
      }
  };
  const std::size_t slots = std::min(workers_.size(), task.calls.size());
  {
    std::vector<std::jthread> threads;
    for (std::size_t slot = 1; slot < slots; ++slot) threads.emplace_back(serve, slot);
    serve(0);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace plumb
