#pragma once
/// The LZF format, as PCD's binary_compressed uses it.

#include <string>
#include <string_view>

namespace plumb::io {

/// Unpacks `packed` into exactly `size` bytes of `result`; false if the packed bytes are damaged or
/// give another number of bytes. Format: a control byte c < 32 is followed by c + 1 literal bytes;
/// else it is a copy of (c >> 5) + 2 bytes (if c >> 5 is 7, the next byte is added to that) from
/// ((c & 31) << 8) + next byte + 1 back. Source: M. Lehmann, LibLZF, description of the format. A
/// copy gives at most 264 bytes from 3, so a larger `size` is refused before it is allocated.
bool unpack_lzf(std::string_view packed, std::size_t size, std::string& result);

}  // namespace plumb::io
