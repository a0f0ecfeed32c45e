#include "plumb/data/io/fence.hpp"

#include <algorithm>
#include <optional>

#include "plumb/data/io/file_text.hpp"

namespace plumb::io {
namespace fs = std::filesystem;
namespace {

std::optional<std::vector<fs::path>>& fence() {
  static std::optional<std::vector<fs::path>> places;
  return places;
}

/// Where a path really leads; of what is not there the part that is, and the rest by name. Empty
/// where nobody can tell, as in a circle of links.
fs::path followed(const fs::path& path) {
  std::error_code error;
  fs::path real = fs::weakly_canonical(fs::absolute(path, error), error);
  if (error) return {};
  return real.has_filename() ? real : real.parent_path();  // "DIR/"
}

bool lies_in(const fs::path& path, const fs::path& place) {
  return !path.empty() && !place.empty() && std::ranges::mismatch(path, place).in2 == place.end();
}

}  // namespace

void set_fence(const std::vector<fs::path>& places) {
  fence().emplace();
  for (const fs::path& place : places) fence()->push_back(followed(place));
}

bool inside(const fs::path& path, const std::vector<fs::path>& places) {
  return std::ranges::any_of(places, [real = followed(path)](const fs::path& place) {
    return lies_in(real, followed(place));
  });
}

bool inside_of_fence(const fs::path& path) {
  return !fence() || std::ranges::any_of(*fence(), [real = followed(path)](const fs::path& place) {
    return lies_in(real, place);
  });
}

void require_inside_of_fence(const fs::path& path) {
  if (!inside_of_fence(path))
    refuse(path,
           "lies outside of what --untrusted lets a pipeline read; name its folder on the command "
           "line, as in --set input=DIR, or leave --untrusted out");
}

}  // namespace plumb::io
