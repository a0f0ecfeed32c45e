#pragma once
/// Files that may be packed with gzip or bzip2.

#include <filesystem>
#include <string>

namespace plumb::source_carmen {

/// The bytes of a file, unpacked where its first bytes say gzip or bzip2 (its name does not matter;
/// several streams one after another are one file). Throws Error: cannot be opened, cut off,
/// damaged, unpacks to far more than a log of its size does (8 MiB and 16 times its size).
std::string unpacked(const std::filesystem::path& file);

}  // namespace plumb::source_carmen
