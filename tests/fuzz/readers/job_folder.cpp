#include "plumb/engine/remote/slurm/job_folder.hpp"

#include "../fuzz.hpp"

using namespace plumb;

/// The files of a job on a shared disk: what was submitted, what a chunk told, what is to be made.
PLUMB_FUZZ_READER(job_folder) {
  const auto parts = fuzz::parts_of(bytes, 3);
  std::filesystem::create_directories(fuzz::folder() / "replies");
  fuzz::file_of(parts[0], "submitted");
  fuzz::file_of(parts[1], "replies/2-4711.7");
  JobFolder job(fuzz::folder());
  job.submitted();
  const auto news = job.news();
  fuzz::require(news.size() * 8 <= parts[1].size(), "no more is told than was written");
  read_task(fuzz::file_of(parts[2], "2-4711.task"));
}
