#include "plumb/data/file_name.hpp"

#include <algorithm>

namespace plumb {

std::string fault_of_file_name(std::string_view name) {
  constexpr std::size_t longest = 200;  // of the 255 bytes that file systems take
  const bool plain = std::none_of(
      name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f || c == '/'; });
  if (plain && !name.empty() && name.front() != '.' && name.size() <= longest) return "";
  return "is not a name for a file or folder (no slashes, no control characters, no dot at the "
         "beginning, 200 bytes at most); choose another";
}

}  // namespace plumb
