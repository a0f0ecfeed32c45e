#include "plumb/engine/run/failures.hpp"

#include <algorithm>
#include <utility>

namespace plumb {

void Failures::add(std::size_t item, std::string why) {
  const std::lock_guard lock(mutex_);
  failed_.push_back({item, std::move(why)});
  count_ = failed_.size();
}

bool Failures::has(std::size_t item) const {
  const std::lock_guard lock(mutex_);
  return std::any_of(failed_.begin(), failed_.end(),
                     [&](const Failed& one) { return one.item == item; });
}

std::vector<Failures::Failed> Failures::all() const {
  const std::lock_guard lock(mutex_);
  std::vector<Failed> sorted = failed_;
  std::sort(sorted.begin(), sorted.end(),
            [](const Failed& a, const Failed& b) { return a.item < b.item; });
  return sorted;
}

std::string Failures::sentence(const std::string& path,
                               const std::function<std::string(std::size_t)>& name_of) const {
  const std::vector<Failed> failed = all();
  std::string text = failed.front().sentence;
  if (failed.size() == 1) return text;
  text += "; " + std::to_string(failed.size() - 1) + (failed.size() >= most ? " or more" : "") +
          " further items of step '" + path + "' failed:";
  for (std::size_t f = 1; f < failed.size() && f < 6; ++f)
    text += (f > 1 ? ", " : " ") + name_of(failed[f].item);
  if (failed.size() > 6) text += ", ...";
  return text;
}

}  // namespace plumb
