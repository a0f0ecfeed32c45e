#include "plumb/pipeline/yaml/syntax.hpp"

#include <algorithm>
#include <vector>

namespace plumb::pipeline {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char c : text) {
    if (c == '\n')
      lines.emplace_back();
    else if (c != '\r')
      lines.back() += c;
  }
  return lines;
}

std::size_t indent_of(const std::string& line) {
  return std::min(line.find_first_not_of(" \t"), line.size());
}

/// A line that is one plain word or several, neither a list's item nor with anything that YAML
/// knows: "form", "use prune.kmeans".
bool bare_words(const std::string& line) {
  const std::size_t begin = indent_of(line);
  return begin < line.size() && line.find_first_of(":#{}[]\"'&*|>\t,") == std::string::npos &&
         line.compare(begin, 2, "- ") != 0;
}

}  // namespace

SyntaxFault syntax_fault(const std::string& text, const Origin& noticed, const std::string& message,
                         const std::optional<Origin>& open) {
  const std::string not_yaml = "this is not YAML: ";
  if (open && message.starts_with("end of ") && message.find("flow") != std::string::npos) {
    const char* bracket = message.find("map") != std::string::npos ? "{" : "[";
    return {*open, not_yaml + "the '" + bracket + "' is not closed.",
            "What follows at line " + std::to_string(noticed.line) + " cannot stand inside it."};
  }
  const auto lines = lines_of(text);
  if (noticed.line < 1 || noticed.line > static_cast<int>(lines.size()))
    return {noticed, not_yaml + message + ".", ""};
  const std::string& line = lines[noticed.line - 1];
  if (const auto tab = line.find('\t'); tab < indent_of(line)) {
    Origin at = noticed;
    at.column = static_cast<int>(tab) + 1;
    return {at, not_yaml + "a tab indents this line.", "Indent with blanks."};
  }
  if (message == "illegal map value") {
    const bool first_colon = line.find(':') + 1 == static_cast<std::size_t>(noticed.column);
    int above = noticed.line - 2;
    while (above >= 0 && indent_of(lines[above]) == lines[above].size()) --above;
    if (first_colon && above >= 0 && bare_words(lines[above])) {
      Origin at = noticed;
      at.line = above + 1;
      at.column = static_cast<int>(indent_of(lines[above])) + 1;
      return {at, not_yaml + "this line has no ':'.", "Write 'key: value'."};
    }
  }
  return {noticed, not_yaml + message + ".", ""};
}

}  // namespace plumb::pipeline
