#pragma once
/// What a file is that somebody took for another.

#include <string>
#include <string_view>

namespace plumb::io {

/// What the first bytes look like, for sentences: "a point cloud (PLY)", "a trajectory (TUM)", "a
/// pipeline". Empty when nothing is recognised.
std::string kind_of_content(std::string_view bytes);

}  // namespace plumb::io
