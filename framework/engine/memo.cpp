#include "plumb/engine/memo.hpp"

namespace plumb {

std::optional<std::vector<AnyValue>> Memo::find(const Hash128& key) {
  const std::lock_guard lock(mutex_);
  const auto at = index_.find(key);
  if (at == index_.end()) return std::nullopt;
  entries_.splice(entries_.begin(), entries_, at->second);
  return at->second->outputs;
}

void Memo::store(const Hash128& key, std::vector<AnyValue> outputs) {
  std::size_t bytes = sizeof(Entry);
  for (const AnyValue& value : outputs) bytes += value.type->bytes(value.value.get());
  const std::lock_guard lock(mutex_);
  if (bytes > budget_ || index_.contains(key)) return;
  entries_.push_front({key, std::move(outputs), bytes});
  index_[key] = entries_.begin();
  bytes_ += bytes;
  while (bytes_ > budget_) {
    bytes_ -= entries_.back().bytes;
    index_.erase(entries_.back().key);
    entries_.pop_back();
  }
}

}  // namespace plumb
