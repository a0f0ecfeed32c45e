#include "plumb/engine/cache/results.hpp"

namespace plumb {

std::size_t memory_of(const StoredResult& result) {
  std::size_t bytes = sizeof(StoredResult) + 64;
  for (const auto& values : result.outputs)
    for (const AnyValue& value : values)
      bytes += sizeof(AnyValue) + (value ? value.type->code->bytes(value.value.get()) : 0);
  return bytes;
}

bool NotedKeys::note(const Hash128& key) {
  const std::lock_guard lock(mutex_);
  return keys_.insert(key).second;
}

bool NotedKeys::has(const Hash128& key) const {
  const std::lock_guard lock(mutex_);
  return keys_.contains(key);
}

SharedResult Results::remembered(const Hash128& key) {
  const std::lock_guard lock(mutex_);
  const auto at = index_.find(key);
  if (at == index_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, at->second);
  return at->second->result;
}

SharedResult Results::find(const Hash128& key, const FaultOf& fault_of) {
  if (auto here = remembered(key)) return here;
  if (!store_ || (fresh_ && !in_store(key))) return nullptr;
  auto stored = store_->find(key, fault_of);
  if (!stored) {
    const std::lock_guard lock(mutex_);
    facts_.erase(key);
    return nullptr;
  }
  auto shared = std::make_shared<const StoredResult>(std::move(*stored));
  insert(key, shared, true);
  return shared;
}

SharedResult Results::keep(const Hash128& key, StoredResult result, const std::string& step) {
  auto shared = std::make_shared<const StoredResult>(std::move(result));
  const bool taken = store_ && store_->put(key, *shared, step);
  insert(key, shared, taken, !(taken && frugal_));
  said_.note(key);
  return shared;
}

SharedResult Results::remember(const Hash128& key, StoredResult result) {
  auto shared = std::make_shared<const StoredResult>(std::move(result));
  insert(key, shared, false);
  return shared;
}

void Results::made_elsewhere(const Hash128& key, const std::string& step) {
  store_->note(key, step, 0);
  said_.note(key);
  const std::lock_guard lock(mutex_);
  facts_[key].in_store = true;
}

bool Results::in_store(const Hash128& key) const {
  const std::lock_guard lock(mutex_);
  const auto at = facts_.find(key);
  return at != facts_.end() && at->second.in_store;
}

std::size_t Results::size_of(const Hash128& key) const {
  {
    const std::lock_guard lock(mutex_);
    const auto at = facts_.find(key);
    if (at != facts_.end() && at->second.bytes > 0) return at->second.bytes;
  }
  return store_ ? store_->bytes_of(key) : 0;
}

void Results::insert(const Hash128& key, const SharedResult& result, bool in_store, bool stays) {
  const std::size_t bytes = memory_of(*result);
  std::list<Entry> gone;  // declared before the lock: what leaves is freed after it
  const std::lock_guard lock(mutex_);
  facts_[key] = {bytes, in_store};
  if (!stays || bytes > budget_ || index_.contains(key)) return;
  entries_.push_front({key, result, bytes});
  index_[key] = entries_.begin();
  bytes_ += bytes;
  while (bytes_ > budget_) {
    bytes_ -= entries_.back().bytes;
    index_.erase(entries_.back().key);
    gone.splice(gone.begin(), entries_, std::prev(entries_.end()));
  }
}

}  // namespace plumb
