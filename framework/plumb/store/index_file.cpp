#include "plumb/store/index_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "plumb/store/blob_file.hpp"
#include "plumb/store/index_tables.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

bool lock_taken(int lock, int how) {
  int done;
  do done = flock(lock, how);
  while (done != 0 && errno == EINTR);
  return done == 0;
}

fs::path beside(const fs::path& file, const char* what) { return file.string() + what; }
fs::path sum_of(const fs::path& store) { return store / "index.sum"; }

/// Also a link that leads nowhere.
bool is_there(const fs::path& file) {
  std::error_code error;
  return fs::symlink_status(file, error).type() != fs::file_type::not_found;
}

/// Empty when the index cannot be read.
std::string written_sum(const fs::path& index) {
  const MappedFile bytes(index);
  return bytes.there() ? hash_of(bytes.bytes()).text() + "\n" : "";
}

/// Whether the file is the one that the last user left.
bool is_as_left(const fs::path& index, const fs::path& sum) {
  if (is_there(beside(index, "-wal"))) return false;  // it leaves none
  const std::string now = written_sum(index);
  return !now.empty() && MappedFile(sum).bytes() == now;
}

/// What of the database SQLite must not open: it would follow a link, and wait for a pipe. "" when
/// it may.
std::string not_to_be_opened(const fs::path& index, Whose whose) {
  for (const char* part : {"", "-wal", "-shm"})
    if (const std::string why = why_refused(beside(index, part), whose); !why.empty())
      return "its file '" + beside(index, part).filename().string() + "' " + why;
  return "";
}

void remove_database(const fs::path& index) {
  for (const char* part : {"", "-wal", "-shm", "-journal"}) unlink(beside(index, part).c_str());
}

}  // namespace

IndexFile::IndexFile(fs::path store, Whose whose) : store_(std::move(store)), whose_(whose) {
  open();
}
IndexFile::~IndexFile() { close(); }

void IndexFile::open() {
  const auto refuse = [this] { fail(std::strerror(errno)); };
  const fs::path lock = store_ / "index.lock";
  if (const std::string why = why_refused(lock, Whose::anyones); !why.empty())
    return fail("its lock '" + lock.string() + "' " + why + "; remove it");
  lock_ = ::open(lock.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
  if (lock_ < 0) return refuse();
  try {
    for (bool open = false; !open;) {
      if (lock_taken(lock_, LOCK_EX | LOCK_NB)) {
        mend();
        open = lock_taken(lock_, LOCK_SH);
        if (!open) return refuse();
      } else {
        if (errno != EWOULDBLOCK || !lock_taken(lock_, LOCK_SH))
          return refuse();  // waits for one that opens or closes it
        open = !is_there(sum_of(store_));
        if (!open) lock_taken(lock_, LOCK_UN);  // that one closed it: we are the first
      }
    }
    connect();
  } catch (const DatabaseError& e) {
    fail(e.what());
  }
}

void IndexFile::connect() {
  if (const std::string why = not_to_be_opened(file(), whose_); !why.empty())
    throw DatabaseError(DatabaseError::Cause::damage, why);
  database_ = std::make_unique<Database>(file());
}

/// Under the lock alone: leaves a sound index, in use.
void IndexFile::mend() {
  remove_unfinished(store_);
  const fs::path sum = sum_of(store_);
  const bool closed = is_there(sum), there = is_there(file());
  std::string why = not_to_be_opened(file(), whose_);
  if (!why.empty()) {
    unlink(sum.c_str());
  } else if (closed) {
    if (!is_as_left(file(), sum))
      why = there ? "its bytes are not those that were left" : "its file is gone";
    if (unlink(sum.c_str()) != 0)
      throw DatabaseError(DatabaseError::Cause::system, std::strerror(errno));
    if (why.empty()) return;
  } else if (there) {
    try {
      Database database(file());
      if (has_tables(database)) {
        why = damage_in(database);
        if (why.empty()) return follow_files(database, store_);
      }
    } catch (const DatabaseError& e) {
      if (e.cause() != DatabaseError::Cause::damage) throw;
      why = e.what();
    }
  }
  rebuild(why);
}

/// Under the lock alone: from the results.
void IndexFile::rebuild(const std::string& why) {
  remove_database(file());
  {
    const std::lock_guard lock(said_mutex_);
    rebuilt_ = why;
  }
  Database database(file());
  make_tables(database);
  follow_files(database, store_);
}

/// Found to be damaged while it is used. Whoever else uses it has the file open: then it is left to
/// the next who is alone.
void IndexFile::mend_while_open(const std::string& why) {
  database_.reset();
  if (!rebuilt().empty()) return fail("it was damaged again, " + why);
  if (!lock_taken(lock_, LOCK_EX | LOCK_NB))
    return fail("it is damaged, " + why + "; it is made anew when no other run uses the cache");
  try {
    rebuild(why);
    if (!lock_taken(lock_, LOCK_SH)) return fail(std::strerror(errno));
    connect();
  } catch (const DatabaseError& e) {
    fail(e.what());
  }
}

void IndexFile::close() {
  if (lock_ < 0) return;
  database_.reset();
  if (fault().empty() && lock_taken(lock_, LOCK_EX | LOCK_NB) && !is_there(sum_of(store_))) seal();
  ::close(lock_);
  lock_ = -1;
}

/// Under the lock alone: certifies what lies there. An index that is not sound gets no checksum,
/// and the next run mends it.
void IndexFile::seal() {
  try {
    {
      Database database(file());
      if (!damage_in(database).empty()) return;
      database.run("PRAGMA wal_checkpoint(TRUNCATE)");
    }
    const std::string sum = written_sum(file());
    if (!is_there(beside(file(), "-wal")) && !sum.empty()) replace_whole(sum_of(store_), sum);
  } catch (const DatabaseError&) {
  }
}

/// No more use of it; others may go on.
void IndexFile::fail(const std::string& why) {
  database_.reset();
  if (lock_ >= 0) lock_taken(lock_, LOCK_UN);
  const std::lock_guard lock(said_mutex_);
  if (fault_.empty()) fault_ = why;
}

std::string IndexFile::rebuilt() const {
  const std::lock_guard lock(said_mutex_);
  return rebuilt_;
}

std::string IndexFile::fault() const {
  const std::lock_guard lock(said_mutex_);
  return fault_;
}

}  // namespace plumb
