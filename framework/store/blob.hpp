#pragma once
/// The bytes of one stored result.

#include <optional>
#include <string>
#include <string_view>

#include "plumb/store/store.hpp"

namespace plumb {

/// "plumb blob 1\n", the key, the outputs (types by name and version), counts, warnings; then XXH3-128 of all that.
std::string blob_of(const Hash128& key, const StoredResult& result);

/// Reads them back. None: another key, cut, altered, or values of a type or version that this program does not know.
std::optional<StoredResult> read_blob(const Hash128& key, std::string_view bytes);

}  // namespace plumb
