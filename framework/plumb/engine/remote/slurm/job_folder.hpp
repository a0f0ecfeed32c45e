#pragma once
/// The folder of one step run's job on a shared disk: what is to be made, and what became of it.
/// Beside the results in the store:
///
///     STORE/jobs/4f0c...e1/         named by the image: the same step run has the same folder in
///     the next run
///         2-4711.task               calls of the second submission, by the driver with this
///         process number submitted                 "2 1234": the last submission and Slurm's
///         number for it replies/2-4711.7          chunk 7 of it: a Notice after each beginning and
///         end of a call log/1234_7.txt            what the chunk's process said

#include <filesystem>
#include <map>
#include <optional>

#include "plumb/engine/remote/worker/task.hpp"

namespace plumb {

/// A line of a chunk's file: a call begins, or ended with a reply.
struct Notice {
  bool ended = false;
  Reply reply;  ///< of a beginning: only the item
};

class JobFolder {
 public:
  explicit JobFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}
  const std::filesystem::path& path() const { return folder_; }

  struct Submitted {
    std::size_t number = 0;
    std::string job;
  };
  std::optional<Submitted> submitted() const;
  /// Writes the calls of submission `number`. Throws Error when the folder cannot be written.
  std::filesystem::path write_task(std::size_t number, const Task& task) const;
  void write_submitted(const Submitted& submitted) const;
  /// What all chunks wrote since the last time this was asked.
  std::vector<Notice> news();
  void remove() const;

 private:
  std::filesystem::path folder_;
  std::map<std::filesystem::path, std::uintmax_t> read_;  ///< how much of each file
};

/// Reads a task. Throws Error.
Task read_task(const std::filesystem::path& file);

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Notice>
void fields(Archive& a, T& n) { a(n.ended, n.reply); }

}  // namespace plumb
