#include "plumb/data/io/plain_text.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace plumb::io {
namespace {

struct Character {
  std::size_t size = 1;  ///< [byte]
  std::uint32_t code = 0;
  enum class Kind { whole, begun, none } kind = Kind::none;  ///< `begun`: the text ends within it
};

/// The character that `text` begins with, by the table of well-formed UTF-8 (Unicode 15, table
/// 3-7): no overlong forms, no surrogates.
Character first_of(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned first = byte(0);
  if (first < 0x80) return {1, first, Character::Kind::whole};
  if (first < 0xc2 || first > 0xf4) return {};
  const std::size_t size = first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
  std::uint32_t code = first & (0x7fu >> size);
  for (std::size_t k = 1; k < size; ++k) {
    if (k == text.size()) return {k, 0, Character::Kind::begun};
    const unsigned low = k > 1 ? 0x80 : first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
    const unsigned high = k > 1 ? 0xbf : first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
    if (byte(k) < low || byte(k) > high) return {};
    code = code << 6 | (byte(k) & 0x3f);
  }
  return {size, code, Character::Kind::whole};
}

/// Of the characters beyond the controls: marks and overrides of direction, line and paragraph
/// separators, what cannot be seen.
bool misleads(std::uint32_t code) {
  constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 9> ranges = {{{0x80, 0x9f},
                                                                              {0xad, 0xad},
                                                                              {0x61c, 0x61c},
                                                                              {0x200b, 0x200f},
                                                                              {0x2028, 0x202e},
                                                                              {0x2060, 0x206f},
                                                                              {0xfeff, 0xfeff},
                                                                              {0xfff9, 0xfffb},
                                                                              {0xe0000, 0xe0fff}}};
  return std::any_of(ranges.begin(), ranges.end(), [&](const auto& range) {
    return code >= range.first && code <= range.second;
  });
}

bool is_control(std::uint32_t code) { return code < 0x20 || code == 0x7f; }

void add_escaped(std::string& all, char letter, std::uint32_t value, int digits) {
  (all += '\\') += letter;
  while (digits-- > 0) all += "0123456789abcdef"[value >> 4 * digits & 15];
}

/// `kept` are control characters that stay.
std::string plain_but(std::string_view text, std::string_view kept) {
  std::string all;
  all.reserve(text.size());
  while (!text.empty()) {
    const Character c = first_of(text);
    if (c.kind != Character::Kind::whole)
      for (const char byte : text.substr(0, c.size))
        add_escaped(all, 'x', static_cast<unsigned char>(byte), 2);
    else if (is_control(c.code) && kept.find(text[0]) == kept.npos)
      add_escaped(all, 'x', c.code, 2);
    else if (misleads(c.code))
      c.code > 0xffff ? add_escaped(all, 'U', c.code, 8) : add_escaped(all, 'u', c.code, 4);
    else
      all += text.substr(0, c.size);
    text.remove_prefix(c.size);
  }
  return all;
}

/// How many bytes at the end of `text` begin a character and do not end it.
std::size_t begun_at_end(std::string_view text) {
  for (std::size_t back = 1; back <= 3 && back <= text.size(); ++back) {
    const auto byte = static_cast<unsigned char>(text[text.size() - back]);
    if (byte < 0x80) return 0;
    if (byte >= 0xc0)
      return first_of(text.substr(text.size() - back)).kind == Character::Kind::begun ? back : 0;
  }
  return 0;
}

bool put(std::streambuf& to, std::string_view text) {
  return to.sputn(text.data(), static_cast<std::streamsize>(text.size())) ==
         static_cast<std::streamsize>(text.size());
}

}  // namespace

std::string plain(std::string_view text) { return plain_but(text, ""); }
std::string plain_lines(std::string_view text) { return plain_but(text, "\n\t"); }

std::string plain_in_quotes(std::string_view text) {
  std::string all = "\"";
  while (!text.empty()) {
    const Character c = first_of(text);
    const std::string_view bytes = text.substr(0, c.size);
    if (c.kind != Character::Kind::whole)
      all += bytes;
    else if (c.code == '"' || c.code == '\\')
      (all += '\\') += bytes;
    else
      all += plain(bytes);
    text.remove_prefix(c.size);
  }
  return all + '"';
}

bool PlainBuffer::end_character() {
  const std::string begun = std::move(begun_);
  begun_.clear();
  return put(to_, plain(begun));
}

PlainBuffer::int_type PlainBuffer::overflow(int_type byte) {
  if (traits_type::eq_int_type(byte, traits_type::eof())) return traits_type::not_eof(byte);
  const char c = traits_type::to_char_type(byte);
  return xsputn(&c, 1) == 1 ? byte : traits_type::eof();
}

std::streamsize PlainBuffer::xsputn(const char* bytes, std::streamsize size) {
  begun_.append(bytes, static_cast<std::size_t>(size));
  const std::size_t left = begun_at_end(begun_);
  const std::string whole = plain_lines(std::string_view(begun_).substr(0, begun_.size() - left));
  begun_.erase(0, begun_.size() - left);
  return put(to_, whole) ? size : 0;
}

int PlainBuffer::sync() {
  const bool good = end_character();
  return to_.pubsync() == 0 && good ? 0 : -1;
}

}  // namespace plumb::io
