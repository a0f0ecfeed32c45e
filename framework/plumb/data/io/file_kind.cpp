#include "plumb/data/io/file_kind.hpp"

#include "plumb/data/io/file_text.hpp"

namespace plumb::io {
namespace {

/// How many numbers the line consists of; 0 when anything else is in it.
std::size_t numbers_in(std::string_view line) {
  std::size_t count = 0;
  double value;
  for (auto word = next_word(line); !word.empty(); word = next_word(line), ++count)
    if (!to_number(word, value)) return 0;
  return count;
}

std::string kind_of_line(std::string_view line) {
  switch (numbers_in(line)) {
    case 0:
      break;
    case 8:
      return "a trajectory (TUM)";
    case 12:
      return "a trajectory (KITTI)";
    default:
      return "lines of numbers";
  }
  if (line.starts_with("VERTEX_") || line.starts_with("EDGE_")) return "a pose graph (g2o)";
  for (const char* word : {"PARAM ", "FLASER ", "ODOM "})
    if (line.starts_with(word)) return "a CARMEN log";
  return line.starts_with("plumb:") ? "a pipeline" : "";
}

}  // namespace

std::string kind_of_content(std::string_view bytes) {
  const std::string_view head = bytes.substr(0, 4096);
  if (head.starts_with("# .PCD") ||
      (head.starts_with("VERSION ") && head.find("\nFIELDS ") != head.npos))
    return "a point cloud (PCD)";
  if (head.starts_with("ply\n") || head.starts_with("ply\r")) return "a point cloud (PLY)";
  if (head.starts_with("\x1f\x8b")) return "a compressed file";
  if (head.find('\0') != head.npos) return "binary data";
  const auto first = head.find_first_not_of(" \t\r\n");
  if (first == head.npos) return "";
  const auto second = head.find_first_not_of(" \t\r\n", first + 1);
  if (head[first] == '{' && second != head.npos && head[second] == '"')
    return head.find("\"$schema\"") != head.npos ? "a JSON Schema" : "JSON";
  Lines lines(head);
  for (std::string_view line; lines.next(line);)
    if (const auto at = line.find_first_not_of(" \t"); at != line.npos && line[at] != '#')
      return kind_of_line(line.substr(at));
  return "";
}

}  // namespace plumb::io
