#include "plumb/pipeline/diagnostics.hpp"

#include <algorithm>

namespace plumb {

std::string Origin::text() const {
  if (line <= 0) return file;
  return file + ":" + std::to_string(line) + ":" + std::to_string(column);
}

std::string Diagnostic::text() const {
  std::string all = origin.text() + ": " + sentence;
  if (!excerpt.empty()) all += "\n" + excerpt;
  if (!hint.empty()) all += "\n  " + hint;
  return all;
}

namespace {

std::string text_of(const std::vector<Diagnostic>& diagnostics) {
  std::string all;
  for (const Diagnostic& d : diagnostics) all += (all.empty() ? "" : "\n") + d.text();
  return all;
}

}  // namespace

PipelineError::PipelineError(std::vector<Diagnostic> diagnostics)
    : Error(text_of(diagnostics)), diagnostics_(std::move(diagnostics)) {}

namespace pipeline {
namespace {

/// The line with a caret under byte `column` (from 1).
std::string excerpt_of(const std::string& line, int number, int column) {
  constexpr std::size_t longest = 160;
  const std::string margin = std::to_string(number);
  std::string below;
  for (std::size_t k = 0; k + 1 < static_cast<std::size_t>(column) && k < line.size(); ++k) {
    const auto byte = static_cast<unsigned char>(line[k]);
    if (byte == '\t')
      below += '\t';
    else if ((byte & 0xC0) != 0x80)
      below += ' ';  // one blank per character, not per byte
  }
  if (line.size() > longest && static_cast<std::size_t>(column) > longest) return "";
  return "  " + margin + " | " + line.substr(0, longest) + "\n  " +
         std::string(margin.size(), ' ') + " | " + below + "^";
}

}  // namespace

void Diagnostics::read(const std::string& file, std::string_view text) {
  if (lines_.count(file)) return;
  files_.push_back(file);
  auto& lines = lines_[file];
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string line(text.substr(0, end));
    if (!line.empty() && line.back() == '\r') line.pop_back();
    lines.push_back(std::move(line));
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
}

void Diagnostics::add(const Origin& origin, std::string sentence, std::string hint) {
  for (const Diagnostic& d : list_)
    if (d.sentence == sentence && d.origin.text() == origin.text()) return;
  Diagnostic d{origin, std::move(sentence), "", std::move(hint)};
  const auto at = lines_.find(origin.file);
  if (at != lines_.end() && origin.line >= 1 && origin.line <= static_cast<int>(at->second.size()))
    d.excerpt = excerpt_of(at->second[origin.line - 1], origin.line, origin.column);
  list_.push_back(std::move(d));
}

void Diagnostics::raise() const {
  if (list_.empty()) return;
  auto sorted = list_;
  const auto place = [&](const Diagnostic& d) {
    const auto file = std::find(files_.begin(), files_.end(), d.origin.file) - files_.begin();
    return std::tuple(file, d.origin.line, d.origin.column);
  };
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const Diagnostic& a, const Diagnostic& b) { return place(a) < place(b); });
  throw PipelineError(std::move(sorted));
}

namespace {

/// Insertions, deletions, replacements and swaps of neighbours that lead from a to b.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<std::size_t> d((a.size() + 1) * width);
  const auto at = [&](std::size_t i, std::size_t j) -> std::size_t& { return d[i * width + j]; };
  for (std::size_t i = 0; i <= a.size(); ++i) at(i, 0) = i;
  for (std::size_t j = 0; j <= b.size(); ++j) at(0, j) = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      at(i, j) =
          std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, at(i - 1, j - 1) + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
    }
  }
  return at(a.size(), b.size());
}

}  // namespace

std::string nearest(std::string_view name, const std::vector<std::string>& known) {
  constexpr std::size_t longest = 80;
  if (name.empty() || name.size() > longest) return "";
  std::string best;
  std::size_t least = std::max<std::size_t>(1, (name.size() + 1) / 3) + 1;
  for (const std::string& candidate : known) {
    if (candidate.size() > longest) continue;
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < least) least = distance, best = candidate;
  }
  if (!best.empty()) return best;
  // 'kmeans' for 'prune.kmeans', 'solved' for 'drift.solved'.
  for (const std::string& candidate : known) {
    const auto dot = candidate.rfind('.');
    if (dot != std::string::npos && candidate.substr(dot + 1) == name) return candidate;
  }
  return "";
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& known) {
  constexpr std::size_t readable = 24;
  const std::string near = nearest(name, known);
  std::string text = near.empty() ? "" : "Did you mean '" + near + "'?";
  if (known.empty()) return text;
  if (known.size() <= readable)
    text += (text.empty() ? "Known: " : "  Known: ") + joined(known) + ".";
  return text;
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

}  // namespace pipeline
}  // namespace plumb
