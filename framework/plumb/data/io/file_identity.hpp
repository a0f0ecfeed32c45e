#pragma once
/// When an input file counts as unchanged.

#include <filesystem>

#include "plumb/data/hash.hpp"

namespace plumb::io {

enum class FileIdentity {
  status,   ///< by size and time of the last change: the file is not read
  content,  ///< by all its bytes
};

/// For this whole process, before anything runs: `--verify-inputs` asks for content.
void identify_files_by(FileIdentity identity);

/// Adds all bytes of a regular file. Throws Error.
void add_bytes(Hasher& hasher, const std::filesystem::path& file);

/// Adds to `hasher` what the file counts by, without its name. False when it cannot be looked at. A
/// folder counts by its status.
bool add_identity(Hasher& hasher, const std::filesystem::path& file);

}  // namespace plumb::io
