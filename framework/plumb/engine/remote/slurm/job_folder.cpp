#include "plumb/engine/remote/slurm/job_folder.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <sstream>

#include "plumb/data/error.hpp"
#include "plumb/store/blob_file.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

void write_file(const fs::path& file, const std::string& bytes) {
  if (!replace_whole(file, bytes))
    throw Error(file.string() + ": cannot be written (" + std::strerror(errno) +
                "); is the cache's disk full?");
}

std::string text_in(const fs::path& file) { return std::string(MappedFile(file).bytes()); }

/// The Notice at a place of a chunk's file, and the place behind it; none when it is being written,
/// or was cut by a kill.
std::optional<Notice> notice_at(std::string_view bytes, std::uintmax_t& place) {
  std::uint64_t size = 0;
  if (place > bytes.size() || bytes.size() - place < sizeof size) return std::nullopt;
  std::memcpy(&size, bytes.data() + place, sizeof size);
  if (size > bytes.size() - place - sizeof size) return std::nullopt;
  const auto begin = static_cast<std::size_t>(place) + sizeof size;
  place = begin + size;
  return from_bytes<Notice>(bytes.substr(begin, size));
}

}  // namespace

std::optional<JobFolder::Submitted> JobFolder::submitted() const {
  std::istringstream in(text_in(folder_ / "submitted"));
  Submitted submitted;
  if (!(in >> submitted.number >> submitted.job)) return std::nullopt;
  return submitted;
}

fs::path JobFolder::write_task(std::size_t number, const Task& task) const {
  std::error_code error;
  for (const char* inner : {"replies", "log"}) fs::create_directories(folder_ / inner, error);
  const fs::path file =
      folder_ / (std::to_string(number) + "-" + std::to_string(getpid()) + ".task");
  write_file(file, to_bytes(task));
  return file;
}

void JobFolder::write_submitted(const Submitted& submitted) const {
  write_file(folder_ / "submitted", std::to_string(submitted.number) + " " + submitted.job + "\n");
}

std::vector<Notice> JobFolder::news() {
  std::vector<Notice> news;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_ / "replies", error)) {
    const MappedFile file(entry.path());
    std::uintmax_t& place = read_[entry.path()];
    try {
      while (auto notice = notice_at(file.bytes(), place)) news.push_back(std::move(*notice));
    } catch (const Error&) {  // the next time goes on behind it
    }
  }
  return news;
}

void JobFolder::remove() const {
  std::error_code error;
  fs::remove_all(folder_, error);
}

Task read_task(const fs::path& file) {
  const std::string bytes = text_in(file);
  if (bytes.empty())
    throw Error(file.string() +
                ": there is no such task; a worker gets it from 'plumb run --executor slurm'");
  return from_bytes<Task>(bytes);
}

}  // namespace plumb
