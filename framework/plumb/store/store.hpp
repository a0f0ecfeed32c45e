#pragma once
/// Results of items in files, so that another run need not make them again.

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "plumb/data/type.hpp"
#include "plumb/store/whose.hpp"

namespace plumb {

/// What one call of a step gave: by output its values (one, or one for each item), and what it
/// counted and warned of.
struct StoredResult {
  std::vector<std::vector<AnyValue>> outputs;
  std::vector<std::pair<std::string, std::uint64_t>> counts;
  std::vector<std::string> warnings;
};

class Holds;
class Index;

/// Whether a process decides what is made, or makes what it is told. Only a driver uses the index:
/// on a network file system it is not safe for several machines, and drivers that share a store
/// must run on one.
enum class StoreRole { driver, worker };

/// What was looked for and not found good in a result: "" for nothing.
using FaultOf = std::function<std::string(const StoredResult&)>;

/// The file by which a store is known.
inline constexpr const char* store_mark = "plumb-store";

/// A folder of results under their keys, a file each:
///
///     DIR/plumb-store            "plumb store 2"
///     DIR/blobs/4f/4f0c...e1     what blob.hpp says, 32 hexadecimal digits of the key
///     DIR/new/                   files that are being written
///     DIR/runs/                  what the runs in progress need (holds.hpp)
///     DIR/index.*                what is known of them without opening them (index.hpp)
///
/// A result is written to `new` and renamed, so that it is there whole or not at all after a kill;
/// what a power cut tore is told by its checksum. Several runs of one machine, and workers on any,
/// may share a folder. All functions are safe from several threads.
///
/// What lies in a store is believed no more than what a step gives: values are checked when they
/// are read (TypeCode::fault), only regular files are, and links are not followed. The folder is
/// made for this user alone; one that others own or may write is refused, as are such files in it,
/// unless that is asked for.
class Store {
 public:
  /// Opens or makes the folder. Throws Error: it is not a store and not empty, a store of another
  /// format, another's, or cannot be written; its sentence begins with `title`, what the user would
  /// change for another folder ("" for "--cache-dir FOLDER").
  explicit Store(const std::filesystem::path& folder, StoreRole role = StoreRole::driver,
                 Whose whose = Whose::own, const std::string& title = "");
  ~Store();  ///< syncs
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// The result under `key`; none when there is none, or when it is damaged or `fault_of` finds
  /// one: then its file is removed.
  std::optional<StoredResult> find(const Hash128& key, const FaultOf& fault_of = nullptr);
  /// Keeps a result of a step (its registered name). A disk that does not take it costs the keeping
  /// and no more: then false, and the first such fault is remembered.
  bool put(const Hash128& key, const StoredResult& result, std::string_view step);
  /// Whether there is a file under `key`, which is about to be used; find may still find it
  /// damaged.
  bool contains(const Hash128& key) const;
  /// The size of its file; 0 when there is none.
  std::size_t bytes_of(const Hash128& key) const;
  /// Tells the index of a result that a worker has put; its size is looked up where it is not
  /// given.
  void note(const Hash128& key, std::string_view step, std::size_t bytes = 0);
  /// Removes a result, if it is there; whoever asks for it makes it again. False when it was not
  /// there.
  bool remove(const Hash128& key);
  /// Writes what the system still holds in memory to the disk, and what the index has collected.
  void sync();

  /// Has other runs leave results where they are until this object is gone (size_bound.hpp), as
  /// they do with all that was found, looked for or put.
  void hold(std::span<const Hash128> keys) const;

  const std::filesystem::path& folder() const { return folder_; }
  Index* index() { return index_.get(); }              ///< none for a worker
  const Holds* holds() const { return holds_.get(); }  ///< none for a worker
  /// What was put here, by this process and by those that work for it.
  std::uint64_t kept_bytes() const { return kept_bytes_; }
  Whose whose() const { return whose_; }
  std::size_t damaged() const { return damaged_; }
  /// The first of them, and what was wrong with it; empty when there was none.
  std::string damage() const;
  /// The first reason why a result could not be kept; empty when there was none.
  std::string fault() const;
  /// Why the index had to be made anew from the results; empty when it had not.
  std::string index_rebuilt() const;
  /// Why the index is not used any more; empty when it is. The results are kept and found without
  /// it.
  std::string index_fault() const;

 private:
  void damage(const Hash128& key, const std::string& why);  ///< removes it, and remembers the first
  bool fail(const std::string& why);                        ///< remembers the first; false

  std::filesystem::path folder_;
  Whose whose_;
  std::atomic<std::size_t> damaged_ = 0, written_ = 0;
  std::atomic<bool> failed_ = false;
  std::string
      token_;  ///< of this process among all that write into the folder, on whatever machine
  std::string fault_, damage_;
  std::atomic<std::uint64_t> kept_bytes_ = 0;
  std::unique_ptr<Index> index_;
  std::unique_ptr<Holds> holds_;
};

}  // namespace plumb
