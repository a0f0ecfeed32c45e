#include "plumb/engine/observe/memory_watch.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace plumb {

std::size_t resident_bytes(int process) {
  const std::string name = "/proc/" + std::to_string(process) + "/statm";
  std::FILE* file = std::fopen(name.c_str(), "re");
  if (!file) return 0;
  unsigned long size = 0, resident = 0, shared = 0;  // pages
  const int read = std::fscanf(file, "%lu %lu %lu", &size, &resident, &shared);
  std::fclose(file);
  static const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return read == 3 && resident > shared ? (resident - shared) * page : 0;
}

MemoryWatch::MemoryWatch(std::chrono::milliseconds interval)
    : interval_(interval), processes_{getpid()} {
  {
    const std::lock_guard lock(mutex_);
    look();
  }
  thread_ = std::thread([this] {
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, interval_, [this] { return stop_; })) look();
  });
}

MemoryWatch::~MemoryWatch() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void MemoryWatch::look() {
  std::size_t bytes = 0;
  for (const int process : processes_) bytes += resident_bytes(process);
  last_ = bytes;
  peak_ = std::max(peak_.load(), bytes);
  for (Running& running : running_) running.peak = std::max(running.peak, bytes);
}

void MemoryWatch::begin(const std::string& step) {
  const std::lock_guard lock(mutex_);
  running_.push_back({step, 0});
  look();
}

std::size_t MemoryWatch::end(const std::string& step) {
  const std::lock_guard lock(mutex_);
  look();
  const auto at = std::find_if(running_.begin(), running_.end(),
                               [&](const Running& running) { return running.step == step; });
  if (at == running_.end()) return last_;
  const std::size_t peak = at->peak;
  running_.erase(at);
  return peak;
}

void MemoryWatch::add_process(int process) {
  const std::lock_guard lock(mutex_);
  if (std::find(processes_.begin(), processes_.end(), process) == processes_.end())
    processes_.push_back(process);
}

void MemoryWatch::remove_process(int process) {
  const std::lock_guard lock(mutex_);
  look();
  std::erase(processes_, process);
}

}  // namespace plumb
