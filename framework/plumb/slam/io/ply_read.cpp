/// PLY files: a text header, then elements as lines or little-endian records. Source: G. Turk, "The
/// PLY polygon file format".

#include <cstring>
#include <optional>

#include "plumb/slam/io/point_columns.hpp"

namespace plumb {
namespace {

using namespace io;
using Path = std::filesystem::path;

struct Property {
  std::string name;
  Number number = Number::f32;
  std::optional<Number> length;  ///< of a list: how its length is stored
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  bool has_list() const {
    for (const auto& property : properties)
      if (property.length) return true;
    return false;
  }
  std::uint64_t step() const {  ///< [byte] of a record, lists not counted
    std::uint64_t sum = 0;
    for (const auto& property : properties)
      if (!property.length) sum += size_of(property.number);
    return sum;
  }
};

struct Header {
  std::vector<Element> elements;
  bool ascii = false;
};

constexpr std::size_t most_properties = 1024;

Number number_of(const Path& file, std::size_t line, std::string_view word) {
  if (word == "char" || word == "int8") return Number::i8;
  if (word == "uchar" || word == "uint8") return Number::u8;
  if (word == "short" || word == "int16") return Number::i16;
  if (word == "ushort" || word == "uint16") return Number::u16;
  if (word == "int" || word == "int32") return Number::i32;
  if (word == "uint" || word == "uint32") return Number::u32;
  if (word == "float" || word == "float32") return Number::f32;
  if (word == "double" || word == "float64") return Number::f64;
  refuse(file, line,
         in_quotes(word) +
             " is not a PLY type: use char, uchar, short, ushort, int, uint, float or double");
}

void read_property(const Path& file, std::size_t at, std::string_view line, Header& header) {
  if (header.elements.empty())
    refuse(file, at, "names a property before any element: correct the header");
  auto& properties = header.elements.back().properties;
  if (properties.size() == most_properties)
    refuse(file, at, "names more than 1024 properties: this is not a PLY file that could be read");
  Property property;
  auto word = next_word(line);
  if (word == "list") {
    property.length = number_of(file, at, next_word(line));
    if (is_float(*property.length))
      refuse(file, at, "gives a list a length that is not a whole number: use uchar or int");
    word = next_word(line);
  }
  property.number = number_of(file, at, word);
  property.name = next_word(line);
  if (property.name.empty()) refuse(file, at, "names no property: correct the header");
  properties.push_back(std::move(property));
}

Header read_header(const Path& file, Lines& lines) {
  std::string_view line;
  if (!lines.next(line) || line != "ply")
    refuse(file, "does not begin with the line 'ply': this is not a PLY file");
  Header header;
  bool has_format = false;
  while (lines.next(line)) {
    const auto at = lines.number();
    const auto key = next_word(line);
    if (key == "comment" || key == "obj_info" || key.empty()) continue;
    if (key == "format") {
      const auto format = next_word(line);
      if (format != "ascii" && format != "binary_little_endian")
        refuse(file, at,
               "the format is " + in_quotes(format) +
                   ": write the file as ascii or binary_little_endian");
      header.ascii = format == "ascii";
      has_format = true;
    } else if (key == "element") {
      Element element;
      element.name = next_word(line);
      const auto count = next_word(line);
      if (!to_number(count, element.count))
        refuse(file, at, in_quotes(count) + " is not a number of elements: correct the header");
      header.elements.push_back(std::move(element));
    } else if (key == "property") {
      read_property(file, at, line, header);
    } else if (key == "end_header") {
      if (!has_format) refuse(file, "its header has no 'format' line: this is not a PLY file");
      return header;
    } else {
      refuse(file, at,
             in_quotes(key) +
                 " is not a keyword of a PLY header: this is not a PLY file, or a damaged one");
    }
  }
  refuse(file, "ends before an 'end_header' line: this is not a PLY file, or one cut short");
}

[[noreturn]] void cut_short(const Path& file, const Element& element) {
  refuse(file, "ends within its elements " + in_quotes(element.name) +
                   ": the file is cut short, write it again");
}

std::uint64_t length_at(const Path& file, Number number, const char* at) {
  std::int64_t length = 0;
  const auto load = [&](auto value) {
    std::memcpy(&value, at, sizeof value);
    length = static_cast<std::int64_t>(value);
  };
  switch (number) {
    case Number::i8:
      load(std::int8_t());
      break;
    case Number::u8:
      load(std::uint8_t());
      break;
    case Number::i16:
      load(std::int16_t());
      break;
    case Number::u16:
      load(std::uint16_t());
      break;
    case Number::i32:
      load(std::int32_t());
      break;
    default:
      load(std::uint32_t());
  }
  if (length < 0) refuse(file, "has a list of negative length: write the file again");
  return static_cast<std::uint64_t>(length);
}

/// Takes the records of `element` off the front of `data`.
void skip_records(const Path& file, const Element& element, std::string_view& data) {
  const auto skip = [&](std::uint64_t count, std::uint64_t size) {
    if (size > 0 && count > data.size() / size) cut_short(file, element);
    data.remove_prefix(count * size);
  };
  if (!element.has_list()) return skip(element.count, element.step());
  for (std::uint64_t k = 0; k < element.count;
       ++k)  // a record takes a byte or more, so this ends with the data
    for (const auto& property : element.properties) {
      std::uint64_t count = 1;
      if (property.length) {
        if (size_of(*property.length) > data.size()) cut_short(file, element);
        count = length_at(file, *property.length, data.data());
        skip(1, size_of(*property.length));
      }
      skip(count, size_of(property.number));
    }
}

/// Takes the lines of `element` off `lines`.
void skip_lines(const Path& file, const Element& element, Lines& lines) {
  std::string_view line;
  for (std::uint64_t k = 0; k < element.count; ++k)
    if (!lines.next(line)) cut_short(file, element);
}

CloudFile read_vertices(const Path& file, const Element& vertex, bool ascii, Lines& lines,
                        std::string_view data) {
  if (vertex.has_list())
    refuse(file, "its vertices have a list property: a cloud's points have plain numbers only");
  std::vector<Column> columns;
  std::size_t offset = 0;
  for (const auto& property : vertex.properties) {
    columns.push_back({property.name, property.number, offset, vertex.step()});
    offset += ascii ? 1 : size_of(property.number);
  }
  if (!ascii) {
    require_room(file, vertex.count, vertex.step(), data.size());
    return from_bytes(file, columns, data, vertex.count);
  }
  require_room(file, vertex.count, 2 * columns.size(), lines.rest().size() + 1);
  return from_text(file, columns, lines, columns.size(), vertex.count);
}

}  // namespace

CloudFile read_ply(const Path& file) {
  const FileBytes bytes(file);
  Lines lines(bytes.view());
  const Header header = read_header(file, lines);
  std::string_view data = lines.rest();
  for (const auto& element : header.elements) {
    if (element.name == "vertex") return read_vertices(file, element, header.ascii, lines, data);
    if (header.ascii)
      skip_lines(file, element, lines);
    else
      skip_records(file, element, data);
  }
  refuse(file, "has no element 'vertex': this PLY file holds no points");
}

}  // namespace plumb
