#include "plumb/slam/io/lzf.hpp"

#include "../fuzz.hpp"

using namespace plumb;

/// Two bytes say how large it is to become.
PLUMB_FUZZ_READER(lzf) {
  if (bytes.size() < 2) throw Error("too short");
  const std::size_t size =
      static_cast<unsigned char>(bytes[0]) + 256u * static_cast<unsigned char>(bytes[1]);
  std::string text;
  if (!io::unpack_lzf(bytes.substr(2), size, text)) throw Error("damaged");
  fuzz::require(text.size() == size, "what is unpacked has the size that was promised");
}
