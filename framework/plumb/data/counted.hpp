#pragma once
/// Numbers of things in sentences.

#include <cstdint>
#include <string>
#include <string_view>

namespace plumb {

/// "3 scans", "1 scan", "1 damaged scan left out". `things` is in the plural, its noun the first or
/// the second word.
std::string counted(std::uint64_t n, std::string_view things);

}  // namespace plumb
