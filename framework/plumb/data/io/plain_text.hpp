#pragma once
/// Text from outside (names, values, lines of files) as a terminal may be given it: nothing in it
/// moves the cursor, colours, turns the reading direction or is no text at all.

#include <streambuf>
#include <string>
#include <string_view>

namespace plumb::io {

/// With every control character as \x1b, every character that turns the reading direction, breaks
/// the line or cannot be seen as \u202e, and every byte that is no UTF-8 as \xff. On one line. What
/// is plain already stays as it is.
std::string plain(std::string_view text);

/// The same with its line ends and tabs.
std::string plain_lines(std::string_view text);

/// In double quotes as YAML and JSON read them: back to the same text, if it is UTF-8. Bytes that
/// are none stay as they are: neither can say them.
std::string plain_in_quotes(std::string_view text);

/// Hands on what is written to it, as plain_lines() makes it; a character may come in pieces.
class PlainBuffer : public std::streambuf {
 public:
  explicit PlainBuffer(std::streambuf& to) : to_(to) {}
  ~PlainBuffer() override { end_character(); }

 protected:
  int_type overflow(int_type byte) override;
  std::streamsize xsputn(const char* bytes, std::streamsize size) override;
  int sync() override;

 private:
  bool end_character();
  std::streambuf& to_;
  std::string begun_;  ///< the first bytes of a character whose others are to come
};

}  // namespace plumb::io
