#include "decompress.hpp"

#include <bzlib.h>
#include <zlib.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "plumb/data/counted.hpp"
#include "plumb/data/io/file_text.hpp"

namespace plumb::source_carmen {
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

/// A text that grows, with room behind it that the codecs write to.
struct Growing {
  std::string bytes;       ///< the text and the room
  std::size_t filled = 0;  ///< [byte] of text
  std::size_t most = 0;    ///< [byte] that it may have

  std::size_t room() {
    if (filled == bytes.size())
      bytes.resize(std::min(most + 1, std::max<std::size_t>(1 << 20, 2 * filled)));
    return bytes.size() - filled;
  }
};

/// Appends one stream to `text` and takes it off the front of `packed`.
template <class Codec>
void unpack_stream(const std::filesystem::path& file, std::string_view& packed, Growing& text) {
  Codec codec;
  auto& stream = codec.stream;
  for (;;) {
    if (text.filled > text.most)
      io::refuse(file, "unpacks to more than " + std::to_string(text.most >> 20) +
                           " MiB, which is far more than a log of its size does: look what it "
                           "holds; if it is a log, unpack it with " +
                           std::string(Codec::name) + " -d and give that");
    constexpr std::size_t block = std::size_t{1} << 30;
    const std::size_t give = std::min(packed.size(), block);
    const std::size_t room = std::min(text.room(), block);
    // Both libraries leave the input as it is, but neither says so in its types.
    stream.next_in = reinterpret_cast<decltype(stream.next_in)>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<unsigned>(give);
    stream.next_out = reinterpret_cast<decltype(stream.next_out)>(text.bytes.data() + text.filled);
    stream.avail_out = static_cast<unsigned>(room);
    const Outcome outcome = codec.step();
    const std::size_t taken = give - stream.avail_in, made = room - stream.avail_out;
    packed.remove_prefix(taken);
    text.filled += made;
    if (outcome == Outcome::end_of_stream) return;
    if (outcome == Outcome::damaged)
      io::refuse(file, "is damaged: its " + std::string(Codec::name) +
                           " data cannot be unpacked after " + counted(text.filled, "bytes") +
                           " of text; fetch the file again");
    if (packed.empty() && made == 0)
      io::refuse(file, "is cut off: its " + std::string(Codec::name) + " data end after " +
                           counted(text.filled, "bytes") + " of text; fetch the file again");
  }
}

template <class Codec>
std::string unpack(const std::filesystem::path& file, std::string_view packed, std::size_t most) {
  Growing text;
  text.most = most;
  while (packed.starts_with(Codec::magic)) unpack_stream<Codec>(file, packed, text);
  // Archives may be padded with zeros.
  if (packed.find_first_not_of('\0') != std::string_view::npos)
    io::refuse(file, "is damaged: other bytes follow its " + std::string(Codec::name) +
                         " data; fetch the file again");
  text.bytes.resize(text.filled);
  return std::move(text.bytes);
}

}  // namespace

std::string unpacked(const std::filesystem::path& file) {
  const io::FileBytes bytes(file);
  const std::string_view view = bytes.view();
  // Logs of ranges shrink to between a quarter and a tenth. More is taken of small files, which may
  // hold little but the same words.
  constexpr std::size_t always = std::size_t{8} << 20, times = 16;
  const std::size_t most = always + times * view.size();
  if (view.starts_with(Bzip2::magic)) return unpack<Bzip2>(file, view, most);
  if (view.starts_with(Gzip::magic)) return unpack<Gzip>(file, view, most);
  return std::string(view);
}

}  // namespace plumb::source_carmen
