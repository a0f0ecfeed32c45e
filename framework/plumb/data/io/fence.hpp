#pragma once
/// Where files may be read while a stranger's pipeline runs (`--untrusted`). Without a fence
/// everything may be read.

#include <filesystem>
#include <string>
#include <vector>

namespace plumb::io {

/// From now on this process reads only `places`: files, and folders with all that is in them. Links
/// are followed before anything is judged, those in `places` too. A second call moves the fence.
/// Not to be called while other threads read.
void set_fence(const std::vector<std::filesystem::path>& places);

/// Whether a path, its links followed, lies in one of the places.
bool inside(const std::filesystem::path& path, const std::vector<std::filesystem::path>& places);

/// Whether a path may be read: always without a fence.
bool inside_of_fence(const std::filesystem::path& path);

/// Throws Error where the path may not be read. Nothing of it has been looked at but its links.
void require_inside_of_fence(const std::filesystem::path& path);

}  // namespace plumb::io
