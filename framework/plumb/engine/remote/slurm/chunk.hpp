#pragma once
/// One chunk of a job on the machine that Slurm chose.

#include <filesystem>

#include "plumb/engine/remote/worker/pool.hpp"
#include "plumb/store/store.hpp"

namespace plumb {

/// Makes the calls of chunk `number`, `size` calls each, of the task in `file`, except those whose
/// result is in the store by now, and writes down what became of each. Throws Error.
void make_chunk(const std::filesystem::path& file, std::size_t number, std::size_t size,
                Store& store, WorkerOptions options);

}  // namespace plumb
