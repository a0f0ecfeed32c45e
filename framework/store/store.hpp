#pragma once
/// Results of items in files, so that another run need not make them again.

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plumb/data/type.hpp"

namespace plumb {

/// What one call of a step gave: by output its values (one, or one for each item), and what it counted and warned of.
struct StoredResult {
  std::vector<std::vector<AnyValue>> outputs;
  std::vector<std::pair<std::string, std::uint64_t>> counts;
  std::vector<std::string> warnings;
};

/// A folder of results under their keys, a file each:
///
///     DIR/plumb-store            "plumb store 1"
///     DIR/blobs/4f/4f0c...e1     what blob.hpp says, 32 hexadecimal digits of the key
///     DIR/new/                   files that are being written
///
/// A result is written to `new` and renamed, so that it is there whole or not at all after a kill; what a power cut tore is told by its checksum. Several
/// threads, runs and machines may share a folder. All functions are safe from several threads.
class Store {
 public:
  /// Opens or makes the folder. Throws Error: it is no store and not empty, a store of another format, or cannot be written.
  explicit Store(const std::filesystem::path& folder);
  ~Store();  ///< syncs
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// The result under `key`; none when there is none, or when it is damaged: then its file is removed.
  std::optional<StoredResult> find(const Hash128& key);
  /// Keeps a result. A disk that does not take it costs the keeping and no more: the first such fault is remembered.
  void put(const Hash128& key, const StoredResult& result);
  /// Writes what the system still holds in memory to the disk.
  void sync();

  const std::filesystem::path& folder() const { return folder_; }
  std::size_t damaged() const { return damaged_; }
  /// The first reason why a result could not be kept; empty when there was none.
  std::string fault() const;

 private:
  std::filesystem::path file_of(const Hash128& key) const;
  void fail(const std::string& why);

  std::filesystem::path folder_;
  std::atomic<std::size_t> damaged_ = 0, written_ = 0;
  std::atomic<bool> failed_ = false;
  std::string fault_;
};

}  // namespace plumb
