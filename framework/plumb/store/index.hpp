#pragma once
/// What a store knows of its results without opening their files: an SQLite database beside them.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "plumb/data/hash.hpp"
#include "plumb/store/whose.hpp"

namespace plumb {

class Database;
class IndexFile;

/// One result of a store.
struct IndexRow {
  Hash128 key;
  std::string step;                 ///< registered name: describe.fpfh
  std::uint64_t bytes = 0;          ///< of its file
  std::int64_t made = 0, used = 0;  ///< [ms] since 1970
};

/// One thing that a step's key was made from, as a reader understands it: "version", "2".
struct Fact {
  std::string name, value;
  bool operator==(const Fact&) const = default;
};

/// What a count of a result is called, and how many.
struct CountOf {
  std::string what;
  std::uint64_t n = 0;
};

/// What a whole step gave in an earlier run, as far as it can be known without opening a result.
struct Recalled {
  std::vector<Hash128> items;                ///< by item: keys of its results
  Hash128 whole;                             ///< key of the result of a step on whole collections
  std::vector<std::vector<Hash128>> values;  ///< of that, by output: hashes of its values
  std::vector<std::string> numbers;          ///< by output: bytes of a value with numbers, or none
  std::vector<CountOf> counts;
  std::vector<std::string> warnings;
  std::vector<Fact> facts;
};

/// The index of a store, which holds nothing that the results do not say themselves but when they
/// were used, why they were made, and hashes of input files:
///
///     DIR/index.sqlite   the tables results, facts, file_hashes and recalled; each row with its
///                        own checksum
///     DIR/index.lock     locked by all who use the index (index_file.hpp)
///     DIR/index.sum      XXH3-128 of index.sqlite, while nobody uses it
///
/// A damaged index is noticed and made anew from the results. What is written is collected and
/// reaches the disk by flush(). Nothing here throws because of what is on the disk: an index that
/// cannot be used answers as if it were empty. All functions are safe from several threads;
/// processes of one machine may share an index.
class Index {
 public:
  explicit Index(std::filesystem::path store, Whose whose = Whose::own);
  ~Index();  ///< flushes
  Index(const Index&) = delete;
  Index& operator=(const Index&) = delete;

  void made(const Hash128& key, std::string_view step, std::uint64_t bytes);
  void used(const Hash128& key);
  void gone(const Hash128& key);

  /// What step `path` of a pipeline was keyed by in pass `pass` of its last run; empty when it is
  /// not known.
  std::vector<Fact> facts(const std::string& pipeline, const std::string& path, int pass);
  void set_facts(const std::string& pipeline, const std::string& path, int pass,
                 std::vector<Fact> facts);

  /// What was remembered of a step under a key of its own (engine/run/step_recall.cpp).
  std::optional<Recalled> recalled(const Hash128& key);
  void set_recalled(const Hash128& key, Recalled recalled);
  /// Counts the results of what was recalled as used when it was, and forgets what was last
  /// recalled before `oldest` [ms since 1970], what has no result left, and, of steps that have no
  /// results of their own, what was last recalled a day before any result that is left was used.
  void settle_recalled(std::int64_t oldest);

  /// The content hash of an input file that had this size and time of change [ns]; none when it is
  /// not known.
  std::optional<Hash128> file_hash(const std::string& path, std::uint64_t size,
                                   std::int64_t mtime_ns);
  void set_file_hash(const std::string& path, std::uint64_t size, std::int64_t mtime_ns,
                     const Hash128& hash);

  /// Writes what was collected, in one transaction.
  void flush();
  /// Looks at every row, and gives rows to results that have none, and takes those away that have
  /// no result.
  void check();
  /// What all results take, by one question to the database.
  std::uint64_t bytes();
  /// All results, least recently used first.
  std::vector<IndexRow> rows();

  /// Why the index had to be made anew from the results; empty when it had not.
  std::string rebuilt() const;
  /// Why the index is not used any more, as on a full disk; empty when it is.
  std::string fault() const;

 private:
  struct Note {
    bool made = false, gone = false;
    std::string step;
    std::uint64_t bytes = 0;
    std::int64_t time = 0;
  };
  struct FileHash {
    std::uint64_t size = 0;
    std::int64_t mtime_ns = 0;
    Hash128 hash;
  };
  using FactsOf = std::tuple<std::string, std::string, int>;
  struct Notes {
    std::unordered_map<Hash128, Note, Hash128Hash> results;
    std::map<FactsOf, std::vector<Fact>> facts;
    std::map<std::string, FileHash> file_hashes;
    std::unordered_map<Hash128, Recalled, Hash128Hash> recalled;
    std::unordered_map<Hash128, std::int64_t, Hash128Hash> recalled_again;
    bool empty() const {
      return results.empty() && facts.empty() && file_hashes.empty() && recalled.empty() &&
             recalled_again.empty();
    }
  };

  void write(Database& database, const Notes& notes);
  /// What was noted of something and is not known to be in the database yet; null for nothing.
  /// notes_mutex_ is held.
  template <class Map>
  const typename Map::mapped_type* noted(Map Notes::*where,
                                         const typename Map::key_type& what) const {
    for (const Notes* notes : {&notes_, &writing_}) {
      const Map& map = notes->*where;
      if (const auto at = map.find(what); at != map.end()) return &at->second;
    }
    return nullptr;
  }

  std::filesystem::path store_;
  std::mutex flush_mutex_;  ///< so that what was noted later is written later
  std::mutex notes_mutex_;
  Notes notes_;    ///< what flush() is to write
  Notes writing_;  ///< what it writes; changed with both mutexes held
  std::unique_ptr<IndexFile> file_;
};

}  // namespace plumb
