#include "plumb/engine/remote/slurm/chunk.hpp"

#include <algorithm>
#include <fstream>
#include <mutex>

#include "plumb/data/error.hpp"
#include "plumb/engine/remote/slurm/job_folder.hpp"
#include "plumb/store/blob_file.hpp"

namespace plumb {

void make_chunk(const std::filesystem::path& file, std::size_t number, std::size_t size,
                Store& store, WorkerOptions options) {
  Task task = read_task(file);
  const std::size_t first = std::min(number * size, task.calls.size()),
                    end = std::min(first + size, task.calls.size());
  std::vector<Call> calls;
  for (std::size_t c = first; c < end; ++c)
    if (!store.contains(task.calls[c].key)) calls.push_back(task.calls[c]);
  task.calls = std::move(calls);
  const auto to =
      file.parent_path() / "replies" / (file.stem().string() + "." + std::to_string(number));
  if (const std::string why = why_refused(to, Whose::anyones); !why.empty())
    throw Error(to.string() + ": " + why + "; remove it");
  std::ofstream out(to, std::ios::binary | std::ios::app);
  std::mutex mutex;
  const auto write = [&](const Notice& notice) {
    const std::string bytes = to_bytes(notice);
    const std::uint64_t length = bytes.size();
    const std::lock_guard lock(mutex);
    out.write(reinterpret_cast<const char*>(&length), sizeof length);
    out.write(bytes.data(), static_cast<std::streamsize>(length));
    if (!out.flush()) throw Error(to.string() + ": cannot be written; is the cache's disk full?");
  };
  options.tries = 1;  // the driver decides over a second one
  WorkerPool pool(std::move(options));
  pool.make(
      task,
      [&](const Reply& reply) {
        write({true, reply});
      },
      [&](std::size_t item) {
        Notice begins;
        begins.reply.item = item;
        write(begins);
        return true;
      });
}

}  // namespace plumb
