#include "plumb/store/upkeep.hpp"

#include <map>

#include "plumb/data/error.hpp"
#include "plumb/store/blob_file.hpp"
#include "plumb/store/holds.hpp"
#include "plumb/store/index.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

void require_index(const Store& store) {
  if (const std::string why = store.index_fault(); !why.empty())
    throw Error(store.folder().string() + ": its index cannot be used (" + why +
                "), so that nothing is known of when results were used; nothing was removed");
}

void remove_unfinished(const fs::path& folder, Pruned& pruned) {
  const auto yesterday = fs::file_time_type::clock::now() - std::chrono::hours(24);
  std::error_code error;
  for (fs::directory_iterator file(folder, error), end; !error && file != end;
       file.increment(error)) {
    std::error_code gone;
    const auto written = file->last_write_time(gone);
    const auto bytes = gone ? 0 : file->file_size(gone);
    if (gone || written > yesterday || !fs::remove(file->path(), gone)) continue;
    ++pruned.unfinished;
    pruned.unfinished_bytes += bytes;
  }
}

}  // namespace

Verified verify(Store& store) {
  Index* index = store.index();
  if (index) index->check();
  std::map<Hash128, IndexRow> rows;
  if (index)
    for (IndexRow& row : index->rows()) rows[row.key] = std::move(row);
  Verified verified;
  for_each_blob(store.folder(), [&](const Hash128& key, const fs::path& file) {
    const MappedFile mapped(file, store.whose());
    if (!mapped.there() && mapped.refused().empty()) return;  // pruned meanwhile
    ++verified.results;
    verified.bytes += mapped.bytes().size();
    const auto row = rows.find(key);
    const auto head = check_blob(key, mapped.bytes());
    if (!head) {
      verified.damaged.push_back((row == rows.end() ? "" : row->second.step + " ") + key.text());
      store.remove(key);
    } else if (index && (row == rows.end() || row->second.step != head->step ||
                         row->second.bytes != mapped.bytes().size())) {
      store.note(key, head->step, mapped.bytes().size());
    }
  });
  store.sync();
  return verified;
}

Pruned prune(Store& store, const PruneLimits& limits) {
  require_index(store);
  store.index()->check();
  const auto now = std::chrono::duration_cast<std::chrono::milliseconds>(
                       std::chrono::system_clock::now().time_since_epoch())
                       .count();
  store.index()->settle_recalled(limits.older ? now - limits.older->count() : 0);
  const auto rows = store.index()->rows();
  require_index(store);
  Pruned pruned;
  for (const IndexRow& row : rows) ++pruned.left, pruned.left_bytes += row.bytes;
  HeldElsewhere elsewhere = store.holds()->elsewhere();
  for (const IndexRow& row : rows) {
    const bool old = limits.older && row.used < now - limits.older->count(),
               over = limits.bytes && pruned.left_bytes > *limits.bytes;
    if (!old && !over) break;  // all that follow were used later
    if (elsewhere.has(row.key)) {
      ++pruned.held;
      continue;
    }
    --pruned.left, pruned.left_bytes -= row.bytes;
    if (!store.remove(row.key)) continue;  // another prune was faster
    ++pruned.results, pruned.bytes += row.bytes;
  }
  remove_unfinished(store.folder() / "new", pruned);
  store.sync();
  return pruned;
}

}  // namespace plumb
