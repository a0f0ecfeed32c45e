#pragma once
/// The files of a store: where a result lies, and how it is written whole, mapped and listed.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "plumb/data/hash.hpp"
#include "plumb/store/blob.hpp"
#include "plumb/store/whose.hpp"

namespace plumb {

/// STORE/blobs/4f/4f0c...e1
std::filesystem::path blob_file(const std::filesystem::path& store, const Hash128& key);

/// Calls `visit` for each result of a store; what is called otherwise is left alone.
void for_each_blob(const std::filesystem::path& store,
                   const std::function<void(const Hash128&, const std::filesystem::path&)>& visit);

/// Why a file is not taken though it is there: "is not a regular file". Empty when it may be.
std::string why_refused(const std::filesystem::path& file, Whose whose);

/// The size of a regular file; none when there is none at that path, or something else: a link, a
/// pipe.
std::optional<std::uint64_t> size_of_file(const std::filesystem::path& file);

/// What a blob's first bytes say; none when it is not there or no blob.
std::optional<BlobHead> head_in(const std::filesystem::path& file, const Hash128& key);

/// Writes a new file whole. False, with errno, when the disk does not take it; nothing is left
/// then.
bool write_whole(const std::filesystem::path& file, std::string_view bytes);
/// The same, of bytes that `give` hands on piece by piece.
using Take = std::function<void(std::string_view)>;
bool write_pieces(const std::filesystem::path& file,
                  const std::function<void(const Take& take)>& give);

/// Puts a file in the place of another, or of none, at once and so that a power cut leaves one of
/// them. False, with errno, when the disk does not take it.
bool replace_whole(const std::filesystem::path& file, std::string_view bytes);

/// Removes what programs that were killed had not written to its end. For one who uses the store
/// alone; while jobs of a cluster may go on without their driver (jobs/ says so) nothing is
/// removed.
void remove_unfinished(const std::filesystem::path& store);

/// A file's bytes where the system keeps them in memory, for as long as this object lives. A file
/// that is removed or replaced meanwhile stays as it was.
class MappedFile {
 public:
  explicit MappedFile(const std::filesystem::path& file, Whose whose = Whose::anyones);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  bool there() const { return there_; }  ///< false: no such file, it cannot be read, or was refused
  /// As why_refused.
  const std::string& refused() const { return refused_; }
  std::string_view bytes() const { return {static_cast<const char*>(begin_), size_}; }

 private:
  void* begin_ = nullptr;
  std::size_t size_ = 0;
  bool there_ = false;
  std::string refused_;
};

}  // namespace plumb
