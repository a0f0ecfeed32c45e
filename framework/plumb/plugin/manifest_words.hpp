#pragma once
/// What manifests are written and read with.

#include <nlohmann/json.hpp>

namespace plumb {

using ManifestJson = nlohmann::ordered_json;

inline constexpr int manifest_version = 3;

/// By their place in Access and Emission.
inline constexpr const char* accesses[] = {"item", "ends", "each", "several", "part"};
inline constexpr const char* emissions[] = {"one", "many", "lazy"};

}  // namespace plumb
