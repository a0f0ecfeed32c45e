#include "plumb/store/database.hpp"

#include <sqlite3.h>

#include <cstring>

namespace plumb {
namespace {

constexpr int wait_ms = 10'000, hardly_ms = 100;  // for another process that writes

DatabaseError::Cause cause_of(int code) {
  switch (code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return DatabaseError::Cause::busy;
    case SQLITE_FULL:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_NOMEM:
      return DatabaseError::Cause::system;
    case SQLITE_IOERR:
      return code == SQLITE_IOERR_SHORT_READ ? DatabaseError::Cause::damage
                                             : DatabaseError::Cause::system;
    default:
      return DatabaseError::Cause::damage;  // no such table, no such column, read-only by its own
                                            // header, ...
  }
}

/// Each value with its type and length, so that no two lists of values give the same bytes.
void row_sum(sqlite3_context* context, int count, sqlite3_value** values) {
  std::string row;
  for (int k = 0; k < count; ++k) {
    const int type = sqlite3_value_type(values[k]);
    row.push_back(static_cast<char>(type));
    if (type == SQLITE_INTEGER) {
      const sqlite3_int64 number = sqlite3_value_int64(values[k]);
      row.append(reinterpret_cast<const char*>(&number), sizeof number);
    } else {
      const void* bytes = sqlite3_value_blob(values[k]);
      const auto size = static_cast<std::uint64_t>(sqlite3_value_bytes(values[k]));
      row.append(reinterpret_cast<const char*>(&size), sizeof size);
      if (bytes) row.append(static_cast<const char*>(bytes), size);
    }
  }
  sqlite3_result_int64(context, static_cast<sqlite3_int64>(hash_of(row).low));
}

}  // namespace

Database::Database(const std::filesystem::path& file) {
  const int code =
      sqlite3_open_v2(file.c_str(), &handle_,
                      SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, nullptr);
  try {
    if (code != SQLITE_OK) refuse(code);
    sqlite3_extended_result_codes(handle_, 1);
    sqlite3_busy_timeout(handle_, wait_ms);
    sqlite3_create_function(handle_, "row_sum", -1, SQLITE_UTF8 | SQLITE_DETERMINISTIC, nullptr,
                            row_sum, nullptr, nullptr);
    run("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL; PRAGMA cell_size_check = ON; "
        "PRAGMA temp_store = MEMORY");
  } catch (...) {
    sqlite3_close(handle_);
    throw;
  }
}

Database::~Database() { sqlite3_close(handle_); }

void Database::refuse(int code) const {
  const std::string what = handle_ ? sqlite3_errmsg(handle_) : sqlite3_errstr(code);
  const int extended = handle_ ? sqlite3_extended_errcode(handle_) : code;
  std::string why = what;
  if (cause_of(extended) == DatabaseError::Cause::system && handle_)
    if (const int system = sqlite3_system_errno(handle_); system != 0)
      why += std::string(", ") + std::strerror(system);
  throw DatabaseError(cause_of(extended), why);
}

void Database::wait_no_more() { sqlite3_busy_timeout(handle_, hardly_ms); }

void Database::run(const char* sql) {
  const int code = sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) refuse(code);
}

std::string Database::ask(const char* sql) {
  Statement statement(*this, sql);
  return statement.next() ? statement.text(0) : "";
}

int Database::changed() const { return sqlite3_changes(handle_); }

Statement::Statement(Database& database, const char* sql) : database_(database) {
  check(sqlite3_prepare_v2(database_.handle_, sql, -1, &handle_, nullptr));
}
Statement::~Statement() { sqlite3_finalize(handle_); }

void Statement::check(int code) const {
  if (code != SQLITE_OK) database_.refuse(code);
}
void Statement::reset() { sqlite3_reset(handle_); }

bool Statement::next() {
  const int code = sqlite3_step(handle_);
  if (code != SQLITE_ROW && code != SQLITE_DONE) database_.refuse(code);
  return code == SQLITE_ROW;
}

std::int64_t Statement::number(int column) const { return sqlite3_column_int64(handle_, column); }

std::string Statement::text(int column) const {
  const void* bytes = sqlite3_column_blob(handle_, column);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(handle_, column));
  return bytes ? std::string(static_cast<const char*>(bytes), size) : std::string();
}

Hash128 Statement::hash(int column) const {
  Hash128 value;
  if (const std::string bytes = text(column); bytes.size() == sizeof value)
    std::memcpy(static_cast<void*>(&value), bytes.data(), sizeof value);
  return value;
}

void Statement::bind(int at, std::int64_t value) { check(sqlite3_bind_int64(handle_, at, value)); }
void Statement::bind(int at, std::string_view value) {
  check(
      sqlite3_bind_text64(handle_, at, value.data(), value.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
}
void Statement::bind(int at, const Bytes& value) {
  check(sqlite3_bind_blob64(handle_, at, value.bytes.data(), value.bytes.size(), SQLITE_TRANSIENT));
}
void Statement::bind(int at, const Hash128& value) {
  bind(at, Bytes{{reinterpret_cast<const char*>(&value), sizeof value}});
}

Transaction::~Transaction() {
  if (open_) try {
      database_.run("ROLLBACK");
    } catch (const DatabaseError&) {
    }  // SQLite may have rolled back itself
}

void Transaction::commit() {
  database_.run("COMMIT");
  open_ = false;
}

}  // namespace plumb
