#include "plumb/slam/io/lzf.hpp"

#include <cstring>

namespace plumb::io {

bool unpack_lzf(std::string_view packed, std::size_t size, std::string& result) {
  if (size / 88 > packed.size()) return false;  // 264 bytes from 3
  result.resize(size);
  const auto* in = reinterpret_cast<const unsigned char*>(packed.data());
  const auto* const in_end = in + packed.size();
  char* out = result.data();
  char* const out_end = out + size;
  while (in < in_end) {
    const unsigned control = *in++;
    if (control < 32) {
      const std::size_t length = control + 1;
      if (static_cast<std::size_t>(in_end - in) < length ||
          static_cast<std::size_t>(out_end - out) < length)
        return false;
      std::memcpy(out, in, length);
      in += length;
      out += length;
      continue;
    }
    std::size_t length = (control >> 5) + 2;
    if (control >> 5 == 7) {
      if (in == in_end) return false;
      length += *in++;
    }
    if (in == in_end) return false;
    const std::size_t back = ((control & 31u) << 8) + *in++ + 1;
    if (static_cast<std::size_t>(out - result.data()) < back ||
        static_cast<std::size_t>(out_end - out) < length)
      return false;
    for (const char* from = out - back; length > 0; --length) *out++ = *from++;  // may overlap
  }
  return out == out_end;
}

}  // namespace plumb::io
