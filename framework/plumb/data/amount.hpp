#pragma once
/// Sizes and ages as people write them: 10GiB, 30d.

#include <chrono>
#include <cstdint>
#include <string>

namespace plumb {

/// "500MB" -> bytes. Throws Error: no number, or no unit of B, kB, MB, GB, TB, KiB, MiB, GiB, TiB.
std::uint64_t bytes_of_text(const std::string& option, const std::string& text);

/// "30d" -> a duration. Throws Error: no number, or no unit of s, min, h, d, w.
std::chrono::milliseconds age_of_text(const std::string& option, const std::string& text);

/// 1536 -> "1.5 KiB"
std::string text_of_bytes(std::uint64_t bytes);

}  // namespace plumb
