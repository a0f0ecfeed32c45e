#pragma once
/// Files that may be packed with gzip or bzip2.

#include <filesystem>
#include <string>

namespace plumb {

/// The bytes of a file, unpacked where its first bytes say gzip or bzip2 (its name does not matter;
/// several streams one after another are one file). Throws Error: cannot be opened, cut off,
/// damaged, larger than `most` bytes.
std::string unpacked(const std::filesystem::path& file, std::size_t most = std::size_t{8} << 30);

}  // namespace plumb
