/// PCD files: a text header, then lines, records, or LZF-packed columns. Source: PCL, "The PCD file
/// format".

#include <cstring>
#include <optional>

#include "plumb/data/counted.hpp"
#include "plumb/slam/io/lzf.hpp"
#include "plumb/slam/io/point_columns.hpp"

namespace plumb {
namespace {

using namespace io;
using Path = std::filesystem::path;

enum class Layout { ascii, binary, compressed };

struct Field {
  std::string name;
  std::uint64_t size = 0;
  char type = '?';
  std::uint64_t count = 1;
};

struct Header {
  std::vector<Field> fields;
  std::uint64_t points = 0;
  std::uint64_t step = 0;   ///< [byte] a point
  std::uint64_t words = 0;  ///< numbers a point
  Layout layout = Layout::ascii;
};

constexpr std::uint64_t most_per_field = 1u << 16;
constexpr std::size_t most_fields = 1024;

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (auto word = next_word(line); !word.empty(); word = next_word(line)) words.push_back(word);
  return words;
}

std::uint64_t whole_number(const Path& file, std::size_t line, std::string_view key,
                           std::string_view word) {
  std::uint64_t value = 0;
  if (!to_number(word, value))
    refuse(file, line,
           std::string(key) + " is " + in_quotes(word) +
               " where a whole number belongs: correct the header");
  return value;
}

Number number_of(const Path& file, const Field& field) {
  const auto any = [&](char type, std::uint64_t size) {
    return field.type == type && field.size == size;
  };
  if (any('F', 4)) return Number::f32;
  if (any('F', 8)) return Number::f64;
  if (any('I', 1)) return Number::i8;
  if (any('I', 2)) return Number::i16;
  if (any('I', 4)) return Number::i32;
  if (any('I', 8)) return Number::i64;
  if (any('U', 1)) return Number::u8;
  if (any('U', 2)) return Number::u16;
  if (any('U', 4)) return Number::u32;
  if (any('U', 8)) return Number::u64;
  refuse(file, "field " + in_quotes(field.name) + " has TYPE " + in_quotes({&field.type, 1}) +
                   " and SIZE " + std::to_string(field.size) +
                   ": a field is F of 4 or 8 bytes, or I or U of 1, 2, 4 or 8");
}

/// SIZE, TYPE and COUNT have one word a field.
void read_per_field(const Path& file, std::size_t line, const std::vector<std::string_view>& words,
                    std::vector<Field>& fields) {
  const auto key = words[0];
  if (words.size() != fields.size() + 1)
    refuse(file, line,
           std::string(key) + " has " + counted(words.size() - 1, "entries") + " for " +
               std::to_string(fields.size()) + " FIELDS: give one for each field");
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const auto word = words[k + 1];
    if (key == "TYPE") {
      if (word.size() != 1) refuse(file, line, "TYPE is " + in_quotes(word) + ": use F, I or U");
      fields[k].type = word[0];
    } else {
      (key == "SIZE" ? fields[k].size : fields[k].count) = whole_number(file, line, key, word);
    }
  }
}

void finish(const Path& file, Header& header) {
  if (header.fields.empty()) refuse(file, "has no FIELDS line before DATA: this is not a PCD file");
  for (const auto& field : header.fields) {
    if (field.count < 1 || field.count > most_per_field)
      refuse(file, "field " + in_quotes(field.name) + " has COUNT " + std::to_string(field.count) +
                       ": a field has 1 to " + std::to_string(most_per_field));
    header.step += size_of(number_of(file, field)) * field.count;
    header.words += field.count;
  }
}

Header read_header(const Path& file, Lines& lines) {
  Header header;
  std::optional<std::uint64_t> points, width, height;
  std::string_view line;
  while (lines.next(line)) {
    const auto words = words_of(line.substr(0, line.find('#')));
    if (words.empty()) continue;
    const auto key = words[0];
    const auto at = lines.number();
    if (key == "FIELDS" || key == "COLUMNS") {
      if (words.size() - 1 > most_fields || words.size() < 2)
        refuse(file, at, "names " + counted(words.size() - 1, "fields") + ": name 1 to 1024");
      header.fields.resize(words.size() - 1);
      for (std::size_t k = 1; k < words.size(); ++k) header.fields[k - 1].name = words[k];
    } else if (key == "SIZE" || key == "TYPE" || key == "COUNT") {
      read_per_field(file, at, words, header.fields);
    } else if (key == "VERSION" || key == "VIEWPOINT") {
      continue;
    } else if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS" || key == "DATA") {
      if (words.size() != 2)
        refuse(file, at, std::string(key) + " needs exactly one entry: correct the header");
      if (key == "WIDTH") width = whole_number(file, at, key, words[1]);
      if (key == "HEIGHT") height = whole_number(file, at, key, words[1]);
      if (key == "POINTS") points = whole_number(file, at, key, words[1]);
      if (key != "DATA") continue;
      if (words[1] == "ascii")
        header.layout = Layout::ascii;
      else if (words[1] == "binary")
        header.layout = Layout::binary;
      else if (words[1] == "binary_compressed")
        header.layout = Layout::compressed;
      else
        refuse(file, at,
               "DATA is " + in_quotes(words[1]) + ": use ascii, binary or binary_compressed");
      if (!points && !width) refuse(file, at, "has neither POINTS nor WIDTH before DATA: add them");
      const std::uint64_t w = width.value_or(1), h = width ? height.value_or(1) : 1;
      if (h != 0 && w > UINT64_MAX / h)
        refuse(file, "WIDTH times HEIGHT is too large for any file: correct the header");
      header.points = points.value_or(w * h);
      if (width && header.points != w * h)
        refuse(file, "POINTS is " + std::to_string(header.points) + " but WIDTH times HEIGHT " +
                         std::to_string(w * h) + ": correct the header");
      finish(file, header);
      return header;
    } else {
      refuse(file, at,
             in_quotes(key) +
                 " is not a keyword of a PCD header: this is not a PCD file, or a damaged one");
    }
  }
  refuse(file, "ends before a DATA line: this is not a PCD file, or one cut short");
}

/// The named numbers of a record; of a field with COUNT n the first. In packed data a field's
/// numbers lie together.
std::vector<Column> columns_of(const Path& file, const Header& header) {
  std::vector<Column> columns;
  std::uint64_t offset = 0;
  for (const auto& field : header.fields) {
    const Number number = number_of(file, field);
    const std::uint64_t bytes = size_of(number) * field.count;
    switch (header.layout) {
      case Layout::ascii:
        columns.push_back({field.name, number, offset, 0});
        offset += field.count;
        break;
      case Layout::binary:
        columns.push_back({field.name, number, offset, header.step});
        offset += bytes;
        break;
      case Layout::compressed:
        columns.push_back({field.name, number, offset, bytes});
        offset += bytes * header.points;
        break;
    }
  }
  return columns;
}

std::string unpacked(const Path& file, const Header& header, std::string_view data) {
  std::uint32_t sizes[2];
  if (data.size() < sizeof sizes) refuse(file, "is cut short behind its header: write it again");
  std::memcpy(sizes, data.data(), sizeof sizes);
  data.remove_prefix(sizeof sizes);
  if (sizes[0] > data.size())
    refuse(file, "promises " + std::to_string(sizes[0]) + " packed bytes but holds " +
                     std::to_string(data.size()) + ": the file is cut short, write it again");
  if (header.points > sizes[1] / header.step || header.points * header.step != sizes[1])
    refuse(file, "its header promises " + counted(header.points, "points") + " of " +
                     counted(header.step, "bytes") + ", but " + std::to_string(sizes[1]) +
                     " bytes are packed: the header is wrong, write the file again");
  std::string result;
  if (!unpack_lzf(data.substr(0, sizes[0]), sizes[1], result))
    refuse(file, "its packed points are damaged: write the file again");
  return result;
}

}  // namespace

CloudFile read_pcd(const Path& file) {
  const FileBytes bytes(file);
  Lines lines(bytes.view());
  const Header header = read_header(file, lines);
  const auto columns = columns_of(file, header);
  if (header.layout == Layout::ascii) {
    // A number and what parts it from the next are two characters; the last line may lack its end.
    require_room(file, header.points, 2 * header.words, lines.rest().size() + 1);
    return from_text(file, columns, lines, header.words, header.points);
  }
  if (header.layout == Layout::compressed) {
    // An empty cloud is packed into nothing at all.
    const std::string data = header.points ? unpacked(file, header, lines.rest()) : std::string();
    return from_bytes(file, columns, data, header.points);
  }
  require_room(file, header.points, header.step, lines.rest().size());
  return from_bytes(file, columns, lines.rest(), header.points);
}

}  // namespace plumb
