#include "plumb/store/index_tables.hpp"

#include <array>
#include <chrono>
#include <set>

#include "plumb/store/blob_file.hpp"

namespace plumb {
namespace {

struct Table {
  std::string name, definition, columns;  ///< the columns that `sum` is of
};

const std::array<Table, 4>& tables() {
  static const std::array<Table, 4> all = {{
      {"results",
       "CREATE TABLE results(key BLOB PRIMARY KEY, step TEXT, bytes INTEGER, made INTEGER, used "
       "INTEGER, sum INTEGER) WITHOUT ROWID",
       "key, step, bytes, made, used"},
      {"facts",
       "CREATE TABLE facts(pipeline TEXT, path TEXT, pass INTEGER, facts BLOB, sum INTEGER, "
       "PRIMARY KEY(pipeline, path, pass)) WITHOUT ROWID",
       "pipeline, path, pass, facts"},
      {"file_hashes",
       "CREATE TABLE file_hashes(path TEXT PRIMARY KEY, size INTEGER, mtime_ns INTEGER, hash BLOB, "
       "sum INTEGER) WITHOUT ROWID",
       "path, size, mtime_ns, hash"},
      {"recalled",
       "CREATE TABLE recalled(key BLOB PRIMARY KEY, recalled BLOB, used INTEGER, sum INTEGER) "
       "WITHOUT ROWID",
       "key, recalled, used"},
  }};
  return all;
}

}  // namespace

void make_tables(Database& database) {
  Transaction all_or_none(database);
  for (const Table& table : tables()) database.run(table.definition.c_str());
  all_or_none.commit();
}

bool has_tables(Database& database) {
  return database.ask("SELECT 1 FROM sqlite_schema LIMIT 1") == "1";
}

std::string damage_in(Database& database) {
  Statement definitions(database, "SELECT sql FROM sqlite_schema ORDER BY rowid");
  for (const Table& table : tables())
    if (!definitions.next() || definitions.text(0) != table.definition)
      return "its tables are not those of this program";
  if (definitions.next()) return "its tables are not those of this program";
  if (const std::string said = database.ask("PRAGMA quick_check(1)"); said != "ok")
    return "its pages do not fit together (" + said + ")";
  for (const Table& table : tables())
    if (database.ask(("SELECT 1 FROM " + table.name + " WHERE sum IS NOT row_sum(" + table.columns +
                      ") LIMIT 1")
                         .c_str()) == "1")
      return "a row of its table '" + table.name + "' is not as it was written";
  return "";
}

void follow_files(Database& database, const std::filesystem::path& store) {
  std::set<Hash128> without;  // first all rows, in the end those without a file
  Statement all(database, "SELECT key FROM results");
  while (all.next()) without.insert(all.hash(0));
  Transaction transaction(database);
  Statement put(database, put_result), take(database, "DELETE FROM results WHERE key = ?1");
  for_each_blob(store, [&](const Hash128& key, const std::filesystem::path& blob) {
    if (without.erase(key) > 0) return;
    std::error_code error;
    const auto bytes = size_of_file(blob);
    const auto written = std::filesystem::last_write_time(blob, error);
    const auto head = head_in(blob, key);
    if (error || !bytes || !head) return;  // gone, or no blob: whoever looks for it will tell
    const auto made = std::chrono::duration_cast<std::chrono::milliseconds>(
                          std::chrono::file_clock::to_sys(written).time_since_epoch())
                          .count();
    put.with(key, head->step, *bytes, made, made).run();
  });
  for (const Hash128& key : without) take.with(key).run();
  transaction.commit();
}

}  // namespace plumb
