#include "plumb/engine/slurm/job_folder.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "plumb/data/error.hpp"
#include "plumb/store/blob_file.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

void write_file(const fs::path& file, const std::string& bytes) {
  if (!replace_whole(file, bytes)) throw Error(file.string() + ": cannot be written (" + std::strerror(errno) + "); is the store's disk full?");
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return std::move(text).str();
}

}  // namespace

std::optional<JobFolder::Submitted> JobFolder::submitted() const {
  std::istringstream in(text_of(folder_ / "submitted"));
  Submitted submitted;
  if (!(in >> submitted.number >> submitted.job)) return std::nullopt;
  return submitted;
}

fs::path JobFolder::write_task(std::size_t number, const Task& task) const {
  std::error_code error;
  for (const char* inner : {"replies", "log"}) fs::create_directories(folder_ / inner, error);
  const fs::path file = folder_ / (std::to_string(number) + "-" + std::to_string(getpid()) + ".task");
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
    std::ifstream in(entry.path(), std::ios::binary);
    std::uintmax_t& place = read_[entry.path()];
    in.seekg(static_cast<std::streamoff>(place));
    for (;;) {
      std::uint64_t size = 0;
      if (!in.read(reinterpret_cast<char*>(&size), sizeof size) || size > (std::uint64_t{1} << 32)) break;
      std::string bytes(size, '\0');
      if (!in.read(bytes.data(), static_cast<std::streamsize>(size))) break;  // being written, or cut by a kill
      place += sizeof size + size;
      try {
        news.push_back(from_bytes<Notice>(bytes));
      } catch (const Error&) {
        break;
      }
    }
  }
  return news;
}

void JobFolder::remove() const {
  std::error_code error;
  fs::remove_all(folder_, error);
}

Task read_task(const fs::path& file) {
  const std::string bytes = text_of(file);
  if (bytes.empty()) throw Error(file.string() + ": there is no such task; a worker gets it from 'plumb run --executor slurm'");
  return from_bytes<Task>(bytes);
}

}  // namespace plumb
