#include "plumb/engine/bookkeeping.hpp"

#include <algorithm>

namespace plumb {

void Bookkeeping::count(const std::string& path, std::string_view what, std::uint64_t n) {
  if (n == 0) return;
  const std::lock_guard lock(mutex_);
  counts_[{path, std::string(what)}] += n;
}

void Bookkeeping::warn(const std::string& path, const std::string& sentence) {
  const std::string said = path + ": " + sentence;
  {
    const std::lock_guard lock(mutex_);
    if (std::find(warnings_.begin(), warnings_.end(), said) != warnings_.end()) return;
    warnings_.push_back(said);
  }
  observer_.note(said);
}

StepTime& Bookkeeping::time_of(const std::string& path) {
  const auto [at, is_new] = time_index_.try_emplace(path, times_.size());
  if (is_new) times_.push_back({path});
  return times_[at->second];
}

void Bookkeeping::add_time(const std::string& path, double seconds) {
  const std::lock_guard lock(mutex_);
  time_of(path).cpu_seconds += seconds;
}

void Bookkeeping::add_item(const std::string& path, bool remembered) {
  const std::lock_guard lock(mutex_);
  StepTime& time = time_of(path);
  ++(remembered ? time.remembered : time.items);
}

std::vector<StepCount> Bookkeeping::counts() const {
  const std::lock_guard lock(mutex_);
  std::vector<StepCount> counts;
  for (const auto& [key, n] : counts_) counts.push_back({key.first, key.second, n});
  return counts;
}

std::vector<std::string> Bookkeeping::warnings() const {
  const std::lock_guard lock(mutex_);
  auto sorted = warnings_;
  std::sort(sorted.begin(), sorted.end());  // threads may have said them in any order
  return sorted;
}

std::vector<StepTime> Bookkeeping::times() const {
  const std::lock_guard lock(mutex_);
  return times_;
}

}  // namespace plumb
