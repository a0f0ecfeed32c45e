/// What the index knows of whole steps of earlier runs, without a result being opened.
#include <algorithm>
#include <chrono>
#include <limits>

#include "plumb/data/error.hpp"
#include "plumb/store/index_file.hpp"
#include "plumb/store/index_rows.hpp"

namespace plumb {
namespace {

Recalled recalled_of(const std::string& bytes) {
  try {
    return from_bytes<Recalled>(bytes);
  } catch (const Error&) {
    refuse_row("recalled");
  }
}

/// When a result was last used, and whether its row knows of that.
struct Use {
  std::int64_t time = 0;
  bool is_new = false;
};
using Uses = std::unordered_map<Hash128, Use, Hash128Hash>;

Uses uses_in(Database& database) {
  Uses uses;
  Statement all(database, "SELECT key, used FROM results");
  while (all.next()) uses[all.hash(0)].time = all.number(1);
  return uses;
}

/// Uses the results of a step that was recalled at `time`. How many of them there are; none when it
/// has no results of its own, as one whose values pass through.
std::optional<std::size_t> renew(Uses& uses, const Recalled& recalled, std::int64_t time) {
  bool any = false;
  std::size_t found = 0;
  const auto see = [&](const Hash128& key) {
    if (key == Hash128{}) return;
    any = true;
    const auto at = uses.find(key);
    if (at == uses.end()) return;
    ++found;
    if (at->second.time < time) at->second = {time, true};
  };
  for (const Hash128& key : recalled.items) see(key);
  see(recalled.whole);
  return any ? std::optional(found) : std::nullopt;
}

/// Runs before this left no result: those that used one may have begun a day earlier.
std::int64_t first_of(const Uses& uses) {
  std::int64_t first = std::numeric_limits<std::int64_t>::max();
  for (const auto& [key, use] : uses) first = std::min(first, use.time);
  return first - std::chrono::milliseconds(std::chrono::hours(24)).count();
}

}  // namespace

std::optional<Recalled> Index::recalled(const Hash128& key) {
  {
    const std::lock_guard lock(notes_mutex_);
    if (const Recalled* recalled = noted(&Notes::recalled, key)) return *recalled;
  }
  std::optional<Recalled> found;
  file_->with([&](Database& database) {
    Statement ask(database,
                  "SELECT recalled, sum IS row_sum(key, recalled, used) FROM recalled WHERE key = "
                  "?1");
    if (!ask.with(key).next()) return;
    if (ask.number(1) != 1) refuse_row("recalled");
    found = recalled_of(ask.text(0));
  });
  if (!found) return found;
  const std::lock_guard lock(notes_mutex_);
  notes_.recalled_again[key] = now_ms();
  return found;
}

void Index::set_recalled(const Hash128& key, Recalled recalled) {
  const std::lock_guard lock(notes_mutex_);
  notes_.recalled[key] = std::move(recalled);
}

void Index::settle_recalled(std::int64_t oldest) {
  flush();
  file_->with([&](Database& database) {
    Transaction transaction(database);
    Uses uses = uses_in(database);
    std::vector<Hash128> forgotten;
    std::vector<std::pair<Hash128, std::int64_t>> without_results;
    Statement all(database,
                  "SELECT key, recalled, used, sum IS row_sum(key, recalled, used) FROM recalled");
    while (all.next()) {
      if (all.number(3) != 1) refuse_row("recalled");
      const auto found = renew(uses, recalled_of(all.text(1)), all.number(2));
      if (all.number(2) < oldest || found == 0u)
        forgotten.push_back(all.hash(0));
      else if (!found)
        without_results.emplace_back(all.hash(0), all.number(2));
    }
    const std::int64_t first = first_of(uses);
    for (const auto& [key, time] : without_results)
      if (time < first) forgotten.push_back(key);
    Statement set(database,
                  "UPDATE results SET used = ?2, sum = row_sum(key, step, bytes, made, ?2) WHERE "
                  "key = ?1 AND sum IS row_sum(key, step, bytes, made, used)");
    for (const auto& [key, use] : uses)
      if (use.is_new) set.with(key, use.time).run();
    Statement forget(database, "DELETE FROM recalled WHERE key = ?1");
    for (const Hash128& key : forgotten) forget.with(key).run();
    transaction.commit();
  });
}

}  // namespace plumb
