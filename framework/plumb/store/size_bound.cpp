#include "plumb/store/size_bound.hpp"

#include <sys/statvfs.h>

#include <algorithm>

#include "plumb/store/holds.hpp"
#include "plumb/store/index.hpp"

namespace plumb {

std::uint64_t default_bound(Store& store) {
  struct statvfs disk {};
  if (!store.index() || statvfs(store.folder().c_str(), &disk) != 0) return default_store_size;
  const std::uint64_t room = store.index()->bytes() + std::uint64_t{disk.f_bavail} * disk.f_frsize;
  return std::min(default_store_size, room / 5 * 4);
}

void Trimmed::add(const Trimmed& later) {
  results += later.results, bytes += later.bytes;
  left_bytes = later.left_bytes, own_bytes = later.own_bytes;
}

Trimmed trim(Store& store, std::uint64_t bound, std::uint64_t most) {
  Trimmed trimmed;
  Index* index = store.index();
  if (!index) return trimmed;
  trimmed.left_bytes = index->bytes();
  if (trimmed.left_bytes <= most) return trimmed;
  index->settle_recalled(0);
  const auto rows = index->rows();
  trimmed.left_bytes = 0;
  for (const IndexRow& row : rows) {
    trimmed.left_bytes += row.bytes;
    if (store.holds()->has(row.key)) trimmed.own_bytes += row.bytes;
  }
  HeldElsewhere elsewhere = store.holds()->elsewhere();
  for (const IndexRow& row : rows) {
    if (trimmed.left_bytes <= bound) break;
    if (store.holds()->has(row.key) || elsewhere.has(row.key)) continue;
    bool removed = false;
    const auto remove = [&] { removed = store.remove(row.key); };
    if (!store.holds()->unless_held(row.key, remove)) continue;
    trimmed.left_bytes -= row.bytes;
    if (!removed) continue;  // another run was faster
    ++trimmed.results, trimmed.bytes += row.bytes;
  }
  index->flush();
  return trimmed;
}

SizeBound::SizeBound(Store* store, std::optional<std::uint64_t> bytes)
    : store_(bytes ? store : nullptr),
      bytes_(bytes.value_or(0)),
      looked_at_(store_ ? store_->kept_bytes() : 0) {}

void SizeBound::after_step() {
  if (!store_) return;
  const std::uint64_t kept = store_->kept_bytes() - looked_at_;
  if (kept > bytes_ / 8) look(bytes_ + bytes_ / 4);
}

void SizeBound::at_end() {
  if (store_) look(bytes_);
}

void SizeBound::look(std::uint64_t most) {
  looked_at_ = store_->kept_bytes();
  trimmed_.add(trim(*store_, bytes_, most));
}

}  // namespace plumb
