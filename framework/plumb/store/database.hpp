#pragma once
/// SQLite, as much of it as the index needs.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "plumb/data/error.hpp"
#include "plumb/data/hash.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace plumb {

/// What SQLite refused. It is one of three: try again later; the disk or the system; or the file is
/// not what was written.
class DatabaseError : public Error {
 public:
  enum class Cause { busy, system, damage };
  DatabaseError(Cause cause, const std::string& what) : Error(what), cause_(cause) {}
  Cause cause() const { return cause_; }

 private:
  Cause cause_;
};

/// Text and bytes as SQLite tells them apart.
struct Bytes {
  std::string_view bytes;
};

/// A database in WAL mode that waits for other processes. SQL has the function row_sum(value, ...)
/// there: 64 bits of XXH3 over values and their types, by which each row is known to be as it was
/// written. Used by one thread at a time. All functions throw DatabaseError.
class Database {
 public:
  explicit Database(const std::filesystem::path& file);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  void run(const char* sql);
  /// From now on others that write are hardly waited for: one who did not go may hold its lock for
  /// ever (as on a file server that is gone).
  void wait_no_more();
  /// The first column of the first row, as text; "" when there is none.
  std::string ask(const char* sql);
  int changed() const;  ///< rows that the last statement wrote

 private:
  friend class Statement;
  [[noreturn]] void refuse(int code) const;
  sqlite3* handle_ = nullptr;
};

/// A prepared statement: `statement.with(key, step); while (statement.next()) statement.number(0)`.
class Statement {
 public:
  Statement(Database& database, const char* sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  /// Begins anew with these values in the place of ?1, ?2, ...
  template <class... V>
  Statement& with(const V&... values) {
    reset();
    int at = 0;
    (bind(++at, values), ...);
    return *this;
  }
  bool next();  ///< whether there is a row (another one)
  void run() {
    while (next()) {
    }
  }
  std::int64_t number(int column) const;
  std::string text(int column) const;  ///< bytes, too
  Hash128 hash(int column) const;      ///< zero when it is none

 private:
  void reset();
  void bind(int at, std::int64_t value);
  void bind(int at, std::string_view value);
  void bind(int at, const Bytes& value);
  void bind(int at, const Hash128& value);
  void check(int code) const;
  Database& database_;
  sqlite3_stmt* handle_ = nullptr;
};

/// All between the beginning and commit() comes to be at once, or none of it.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) {
    database_.run("BEGIN IMMEDIATE");
  }
  ~Transaction();
  void commit();

 private:
  Database& database_;
  bool open_ = true;
};

}  // namespace plumb
