/// What is asked of the index and written to it. What it knows of whole steps: index_recalled.cpp;
/// how it is opened, checked and closed: index_file.cpp.
#include "plumb/store/index.hpp"

#include <algorithm>

#include "plumb/store/blob_file.hpp"
#include "plumb/store/index_file.hpp"
#include "plumb/store/index_rows.hpp"
#include "plumb/store/index_tables.hpp"

namespace plumb {

Index::Index(std::filesystem::path store, Whose whose)
    : store_(std::move(store)), file_(std::make_unique<IndexFile>(store_, whose)) {}
Index::~Index() { flush(); }

std::string Index::rebuilt() const { return file_->rebuilt(); }
std::string Index::fault() const { return file_->fault(); }

void Index::made(const Hash128& key, std::string_view step, std::uint64_t bytes) {
  const std::lock_guard lock(notes_mutex_);
  notes_.results[key] = {true, false, std::string(step), bytes, now_ms()};
}

void Index::used(const Hash128& key) {
  const std::lock_guard lock(notes_mutex_);
  Note& note = notes_.results[key];
  note.gone = false;
  note.time = now_ms();
}

void Index::gone(const Hash128& key) {
  const std::lock_guard lock(notes_mutex_);
  notes_.results[key] = {false, true, "", 0, 0};
}

std::vector<Fact> Index::facts(const std::string& pipeline, const std::string& path, int pass) {
  {
    const std::lock_guard lock(notes_mutex_);
    if (const auto* facts = noted(&Notes::facts, {pipeline, path, pass})) return *facts;
  }
  std::vector<Fact> found;
  file_->with([&](Database& database) {
    Statement ask(database,
                  "SELECT facts, sum IS row_sum(pipeline, path, pass, facts) FROM facts WHERE "
                  "pipeline = ?1 AND path = ?2 AND pass = ?3");
    if (!ask.with(pipeline, path, pass).next()) return;
    if (ask.number(1) != 1) refuse_row("facts");
    try {
      found = from_bytes<std::vector<Fact>>(ask.text(0));
    } catch (const Error&) {
      refuse_row("facts");
    }
  });
  return found;
}

void Index::set_facts(const std::string& pipeline, const std::string& path, int pass,
                      std::vector<Fact> facts) {
  const std::lock_guard lock(notes_mutex_);
  notes_.facts[{pipeline, path, pass}] = std::move(facts);
}

std::optional<Hash128> Index::file_hash(const std::string& path, std::uint64_t size,
                                        std::int64_t mtime_ns) {
  {
    const std::lock_guard lock(notes_mutex_);
    if (const FileHash* seen = noted(&Notes::file_hashes, path))
      return seen->size == size && seen->mtime_ns == mtime_ns ? std::optional(seen->hash)
                                                              : std::nullopt;
  }
  std::optional<Hash128> found;
  file_->with([&](Database& database) {
    Statement ask(database,
                  "SELECT size, mtime_ns, hash, sum IS row_sum(path, size, mtime_ns, hash) FROM "
                  "file_hashes WHERE path = ?1");
    if (!ask.with(path).next()) return;
    if (ask.number(3) != 1) refuse_row("file_hashes");
    if (static_cast<std::uint64_t>(ask.number(0)) == size && ask.number(1) == mtime_ns)
      found = ask.hash(2);
  });
  return found;
}

void Index::set_file_hash(const std::string& path, std::uint64_t size, std::int64_t mtime_ns,
                          const Hash128& hash) {
  const std::lock_guard lock(notes_mutex_);
  notes_.file_hashes[path] = {size, mtime_ns, hash};
}

/// Whoever asks meanwhile finds what is being written in the notes until it is in the database.
void Index::flush() {
  const std::lock_guard one_flush(flush_mutex_);
  {
    const std::lock_guard lock(notes_mutex_);
    std::swap(writing_, notes_);
  }
  if (writing_.empty()) return;
  bool written = false;
  file_->with([&](Database& database) {
    Transaction transaction(database);
    write(database, writing_);
    transaction.commit();
    written = true;
  });
  Notes done;  // declared before the lock: what was written is freed after it
  const std::lock_guard lock(notes_mutex_);
  if (!written && fault().empty()) {  // others kept it busy: the next time
    notes_.results.merge(writing_.results);
    notes_.facts.merge(writing_.facts);
    notes_.file_hashes.merge(writing_.file_hashes);
    notes_.recalled.merge(writing_.recalled);
    notes_.recalled_again.merge(writing_.recalled_again);
  }
  std::swap(done, writing_);
}

void Index::write(Database& database, const Notes& notes) {
  Statement put(database, put_result);
  Statement use(database,
                "UPDATE results SET used = ?2, sum = row_sum(key, step, bytes, made, ?2) "
                "WHERE key = ?1 AND sum IS row_sum(key, step, bytes, made, used)");
  Statement known(database, "SELECT 1 FROM results WHERE key = ?1");
  Statement take(database, "DELETE FROM results WHERE key = ?1");
  for (const auto& [key, note] : notes.results) {
    if (note.gone)
      take.with(key).run();
    else if (note.made)
      put.with(key, note.step, note.bytes, note.time, note.time).run();
    else {
      use.with(key, note.time).run();
      if (database.changed() > 0) continue;
      if (known.with(key).next()) refuse_row("results");
      const auto file =
          blob_file(store_, key);  // made by a run that was killed before it could say so
      const auto bytes = size_of_file(file);
      if (const auto head = head_in(file, key); head && bytes)
        put.with(key, head->step, *bytes, note.time, note.time).run();
    }
  }
  Statement put_facts(
      database, "INSERT OR REPLACE INTO facts VALUES(?1, ?2, ?3, ?4, row_sum(?1, ?2, ?3, ?4))");
  for (const auto& [of, list] : notes.facts)
    put_facts.with(std::get<0>(of), std::get<1>(of), std::get<2>(of), Bytes{to_bytes(list)}).run();
  Statement put_hash(
      database,
      "INSERT OR REPLACE INTO file_hashes VALUES(?1, ?2, ?3, ?4, row_sum(?1, ?2, ?3, ?4))");
  for (const auto& [path, seen] : notes.file_hashes)
    put_hash.with(path, seen.size, seen.mtime_ns, seen.hash).run();
  Statement put_recalled(database,
                         "INSERT OR REPLACE INTO recalled VALUES(?1, ?2, ?3, row_sum(?1, ?2, ?3))");
  for (const auto& [key, recalled] : notes.recalled)
    put_recalled.with(key, Bytes{to_bytes(recalled)}, now_ms()).run();
  Statement again(database,
                  "UPDATE recalled SET used = ?2, sum = row_sum(key, recalled, ?2) WHERE key = ?1 "
                  "AND sum IS row_sum(key, recalled, used)");
  for (const auto& [key, time] : notes.recalled_again) again.with(key, time).run();
}

void Index::check() {
  flush();
  file_->with([&](Database& database) {
    if (const std::string why = damage_in(database); !why.empty())
      throw DatabaseError(DatabaseError::Cause::damage, why);
    follow_files(database, store_);
  });
}

std::uint64_t Index::bytes() {
  flush();
  std::int64_t all = 0;
  file_->with([&](Database& database) {
    Statement ask(database, "SELECT sum(bytes) FROM results");
    if (ask.next()) all = ask.number(0);
  });
  return static_cast<std::uint64_t>(std::max<std::int64_t>(all, 0));
}

std::vector<IndexRow> Index::rows() {
  flush();
  std::vector<IndexRow> all;
  file_->with([&](Database& database) {
    std::vector<IndexRow> rows;
    Statement ask(database,
                  "SELECT key, step, bytes, made, used, sum IS row_sum(key, step, bytes, made, "
                  "used) FROM results ORDER BY used, key");
    while (ask.next()) {
      if (ask.number(5) != 1) refuse_row("results");
      rows.push_back({ask.hash(0), ask.text(1), static_cast<std::uint64_t>(ask.number(2)),
                      ask.number(3), ask.number(4)});
    }
    all = std::move(rows);
  });
  return all;
}

}  // namespace plumb
