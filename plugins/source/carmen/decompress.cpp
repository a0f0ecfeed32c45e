#include "decompress.hpp"

#include <bzlib.h>
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <string_view>

#include "plumb/data/io/file_text.hpp"

namespace plumb {
namespace {

enum class Outcome { more, end_of_stream, damaged };

/// bzip2's and zlib's streams have the same members and differ in their functions.
struct Bzip2 {
  static constexpr std::string_view name = "bzip2", magic = "BZh";
  bz_stream stream{};
  Bzip2() { BZ2_bzDecompressInit(&stream, 0, 0); }
  ~Bzip2() { BZ2_bzDecompressEnd(&stream); }
  Outcome step() {
    const int result = BZ2_bzDecompress(&stream);
    if (result == BZ_STREAM_END) return Outcome::end_of_stream;
    return result == BZ_OK ? Outcome::more : Outcome::damaged;
  }
};

struct Gzip {
  static constexpr std::string_view name = "gzip", magic = "\x1f\x8b";
  z_stream stream{};
  Gzip() { inflateInit2(&stream, 15 + 16); }
  ~Gzip() { inflateEnd(&stream); }
  Outcome step() {
    const int result = inflate(&stream, Z_NO_FLUSH);
    if (result == Z_STREAM_END) return Outcome::end_of_stream;
    return result == Z_OK || result == Z_BUF_ERROR ? Outcome::more : Outcome::damaged;
  }
};

/// Appends one stream to `text` and takes it off the front of `packed`.
template <class Codec>
void unpack_stream(const std::filesystem::path& file, std::string_view& packed, std::string& text,
                   std::size_t most) {
  Codec codec;
  auto& stream = codec.stream;
  std::size_t filled = text.size();
  for (;;) {
    if (filled > most)
      io::refuse(file, "unpacks to more than " + std::to_string(most >> 20) +
                           " MB, so it is no log: look what it holds");
    if (filled == text.size()) text.resize(std::max<std::size_t>(1 << 20, 2 * text.size()));
    constexpr std::size_t block = std::size_t{1} << 30;
    const std::size_t give = std::min(packed.size(), block);
    const std::size_t room = std::min(text.size() - filled, block);
    // Both libraries leave the input as it is, but neither says so in its types.
    stream.next_in = reinterpret_cast<decltype(stream.next_in)>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<unsigned>(give);
    stream.next_out = reinterpret_cast<decltype(stream.next_out)>(text.data() + filled);
    stream.avail_out = static_cast<unsigned>(room);
    const Outcome outcome = codec.step();
    const std::size_t taken = give - stream.avail_in, made = room - stream.avail_out;
    packed.remove_prefix(taken);
    filled += made;
    if (outcome == Outcome::end_of_stream) break;
    if (outcome == Outcome::damaged)
      io::refuse(file, "is damaged: its " + std::string(Codec::name) +
                           " data cannot be unpacked after " + std::to_string(filled) +
                           " bytes of text; fetch the file again");
    if (packed.empty() && made == 0)
      io::refuse(file, "is cut off: its " + std::string(Codec::name) + " data end after " +
                           std::to_string(filled) + " bytes of text; fetch the file again");
  }
  text.resize(filled);
}

template <class Codec>
std::string unpack(const std::filesystem::path& file, std::string_view packed, std::size_t most) {
  std::string text;
  while (packed.starts_with(Codec::magic)) unpack_stream<Codec>(file, packed, text, most);
  // Archives may be padded with zeros.
  if (packed.find_first_not_of('\0') != std::string_view::npos)
    io::refuse(file, "is damaged: other bytes follow its " + std::string(Codec::name) +
                         " data; fetch the file again");
  return text;
}

}  // namespace

std::string unpacked(const std::filesystem::path& file, std::size_t most) {
  const io::FileBytes bytes(file);
  const std::string_view view = bytes.view();
  if (view.starts_with(Bzip2::magic)) return unpack<Bzip2>(file, view, most);
  if (view.starts_with(Gzip::magic)) return unpack<Gzip>(file, view, most);
  return std::string(view);
}

}  // namespace plumb
