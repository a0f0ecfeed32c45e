#pragma once
/// The database of an index from its opening to its closing: who may trust it, and who mends it.

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

#include "plumb/store/database.hpp"
#include "plumb/store/whose.hpp"

namespace plumb {

/// DIR/index.sqlite. All who use it hold DIR/index.lock shared. The first to come and the last to
/// go hold it alone: the last one checks every row and leaves the checksum of the whole file in
/// DIR/index.sum; the first one compares it and takes it away. Without it a run ended uncleanly,
/// and every row is checked instead. The database is never open while the lock changes hands, so
/// that whoever holds it alone may replace the file.
class IndexFile {
 public:
  IndexFile(std::filesystem::path store, Whose whose);
  ~IndexFile();
  IndexFile(const IndexFile&) = delete;
  IndexFile& operator=(const IndexFile&) = delete;

  /// Runs what asks the database, one thread at a time. When that is found to be damaged it is made
  /// anew and asked again; what else is wrong ends its use.
  template <class Action>
  void with(Action action) {
    const std::lock_guard lock(database_mutex_);
    for (int attempt = 0; database_ && attempt < 2; ++attempt) {
      try {
        return action(*database_);
      } catch (const DatabaseError& e) {
        if (e.cause() == DatabaseError::Cause::busy) return database_->wait_no_more();
        if (e.cause() == DatabaseError::Cause::system) return fail(e.what());
        mend_while_open(e.what());
      }
    }
  }

  /// Why it had to be made anew from the results; empty when it had not.
  std::string rebuilt() const;
  /// Why it is not used any more, as on a full disk; empty when it is.
  std::string fault() const;

 private:
  void open();
  void close();
  void mend();
  void seal();
  void connect();
  void mend_while_open(const std::string& why);
  void rebuild(const std::string& why);
  void fail(const std::string& why);
  std::filesystem::path file() const { return store_ / "index.sqlite"; }

  std::filesystem::path store_;
  Whose whose_;
  int lock_ = -1;
  std::mutex database_mutex_;
  mutable std::mutex said_mutex_;
  std::unique_ptr<Database> database_;  ///< none: not to be used
  std::string rebuilt_, fault_;
};

}  // namespace plumb
