#pragma once
/// The bytes of one stored result.

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "plumb/store/store.hpp"

namespace plumb {

/// What a blob says of itself: all that the index knows of it.
struct BlobHead {
  Hash128 key;
  std::string step;  ///< registered name of the step that made it: describe.fpfh
};

/// As many bytes of a file as read_head wants to see.
inline constexpr std::size_t blob_head_size = 512;

/// "plumb blob 2\n", the key, the step, the outputs (types by name and version), counts, warnings;
/// then XXH3-128 of all that. Arrays of plain values begin at multiples of 16 bytes
/// (data/archive.hpp), so that they can be read where the file is mapped.
std::string blob_of(const Hash128& key, const StoredResult& result, std::string_view step);

/// About as many bytes as the blob of a result has, and not fewer.
std::size_t size_of_blob(const StoredResult& result);

/// As blob_of, handed on piece by piece, so that a big one is never in memory a second time.
void give_blob(const Hash128& key, const StoredResult& result, std::string_view step,
               const std::function<void(std::string_view)>& take);

/// Reads them back. None, and why if that is asked: another key, cut, altered, values of a type or
/// version that this program does not know, or one that no step may give (TypeCode::fault), which a
/// right checksum does not make good.
std::optional<StoredResult> read_blob(const Hash128& key, std::string_view bytes,
                                      std::string* why = nullptr);

/// The head, when the bytes are whole: this key, the checksum fits, and the values are such as a
/// step may give, as far as this program knows their types.
std::optional<BlobHead> check_blob(const Hash128& key, std::string_view bytes);

/// The head from the beginning of a blob alone, whose rest is not looked at. None: it is no blob,
/// or another key's.
std::optional<BlobHead> read_head(const Hash128& key, std::string_view beginning);

}  // namespace plumb
