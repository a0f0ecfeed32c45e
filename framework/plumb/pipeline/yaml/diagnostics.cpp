#include "plumb/pipeline/yaml/diagnostics.hpp"

#include <algorithm>
#include <tuple>

#include "plumb/data/counted.hpp"
#include "plumb/data/io/plain_text.hpp"

namespace plumb {

std::string Origin::text() const {
  if (line <= 0) return file;
  return file + ":" + std::to_string(line) + ":" + std::to_string(column);
}

std::string Diagnostic::text() const {
  std::string all = io::plain(origin.text()) + ": " + io::plain(sentence);
  if (!excerpt.empty()) all += "\n" + io::plain_lines(excerpt);
  if (!hint.empty()) all += "\n  " + io::plain(hint);
  return all;
}

namespace {

constexpr std::size_t most_told = 40;  // as many as anybody reads

std::string text_of(const std::vector<Diagnostic>& diagnostics, bool open) {
  std::string all;
  const std::size_t told = std::min(diagnostics.size(), most_told);
  for (std::size_t k = 0; k < told; ++k) all += (all.empty() ? "" : "\n") + diagnostics[k].text();
  const std::size_t left = diagnostics.size() - told;
  if (left > 0)
    all += "\nand " + std::to_string(left) + " more" +
           (open ? ", and what was not looked for behind so many" : "") + ".";
  return all;
}

}  // namespace

PipelineError::PipelineError(std::vector<Diagnostic> diagnostics, bool open)
    : Error(text_of(diagnostics, open)), diagnostics_(std::move(diagnostics)) {}

namespace pipeline {
namespace {

constexpr std::size_t most_kept = 100;    // mistakes; then nothing more is looked for
constexpr std::size_t most_words = 1000;  // [byte] of a sentence
constexpr std::size_t most_shown = 160;   // [byte] of a line

/// The line with a caret under byte `column` (from 1).
std::string excerpt_of(std::string_view line, int number, int column) {
  const std::size_t before =
      std::min(static_cast<std::size_t>(std::max(column - 1, 0)), line.size());
  if (before >= most_shown) return "";
  const std::string margin = std::to_string(number);
  std::string below;
  for (const unsigned char byte : io::plain_lines(line.substr(0, before))) {
    if (byte == '\t')
      below += '\t';
    else if ((byte & 0xC0) != 0x80)
      below += ' ';  // one blank per character, not per byte
  }
  return "  " + margin + " | " + io::plain_lines(line.substr(0, most_shown)) + "\n  " +
         std::string(margin.size(), ' ') + " | " + below + "^";
}

/// A long sentence without its middle: what it is about is said first, what is wrong with it last.
std::string shortened(std::string text) {
  constexpr std::size_t end = 300;
  if (text.size() > most_words) text.replace(most_words - end, text.size() - most_words, " ... ");
  return text;
}

std::string_view line_of(std::string_view text, int number) {
  for (; number > 1 && !text.empty(); --number)
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  text = text.substr(0, text.find('\n'));
  if (text.ends_with('\r')) text.remove_suffix(1);
  return text;
}

}  // namespace

void Diagnostics::read(const std::string& file, std::string_view text) {
  if (texts_.try_emplace(file, text).second) files_.push_back(file);
}

std::string Diagnostics::excerpt_at(const Origin& origin) const {
  const auto at = texts_.find(origin.file);
  if (at == texts_.end() || origin.line < 1) return "";
  const std::string_view line = line_of(at->second, origin.line);
  return line.empty() ? "" : excerpt_of(line, origin.line, origin.column);
}

void Diagnostics::add(const Origin& origin, std::string sentence, std::string hint) {
  sentence = shortened(std::move(sentence));
  for (const Diagnostic& d : list_)
    if (d.sentence == sentence && d.origin.text() == origin.text()) return;
  list_.push_back({origin, std::move(sentence), excerpt_at(origin), shortened(std::move(hint))});
  if (list_.size() >= most_kept) raise();
}

namespace {

/// What is said of a reference behind the place where it stands: "'$leaf' does not serve: ...".
std::string_view said_of_reference(const Diagnostic& diagnostic) {
  const std::string_view sentence = diagnostic.sentence;
  const auto at = sentence.find(": '$");
  const bool does_not_serve =
      at != sentence.npos && sentence.find("' does not serve: ", at) != sentence.npos;
  return does_not_serve ? sentence.substr(at) : "";
}

/// A value that does not serve where many steps refer to it is one mistake: told of the first
/// place, with the number of the others.
std::vector<Diagnostic> told_once(const std::vector<Diagnostic>& sorted) {
  std::vector<Diagnostic> kept;
  std::vector<std::size_t> more;  // places, of each that is kept
  for (const Diagnostic& one : sorted) {
    const auto said = said_of_reference(one);
    const auto same = std::find_if(kept.begin(), kept.end(), [&](const Diagnostic& d) {
      return !said.empty() && said_of_reference(d) == said && d.hint == one.hint;
    });
    if (same != kept.end())
      ++more[static_cast<std::size_t>(same - kept.begin())];
    else
      kept.push_back(one), more.push_back(0);
  }
  for (std::size_t k = 0; k < kept.size(); ++k)
    if (more[k] > 0)
      kept[k].sentence.replace(kept[k].sentence.size() - 1, 1,
                               "; nor does it in " + counted(more[k], "more places") + ".");
  return kept;
}

}  // namespace

void Diagnostics::raise() const {
  if (list_.empty()) return;
  auto sorted = list_;
  const auto place = [&](const Diagnostic& d) {
    const auto file = std::find(files_.begin(), files_.end(), d.origin.file) - files_.begin();
    return std::tuple(file, d.origin.line, d.origin.column);
  };
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const Diagnostic& a, const Diagnostic& b) { return place(a) < place(b); });
  throw PipelineError(told_once(sorted), list_.size() >= most_kept);
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
  constexpr std::size_t longest = 80,
                        most_work = 2000000;  // letters held against letters: some milliseconds
  if (name.empty() || name.size() > longest) return "";
  std::size_t work = 0;
  std::string best;
  std::size_t least = std::max<std::size_t>(1, (name.size() + 1) / 3) + 1;
  for (const std::string& candidate : known) {
    const auto [shorter, longer] = std::minmax({candidate.size(), name.size()});
    if (candidate.size() > longest || longer - shorter >= least) continue;
    if ((work += shorter * longer) > most_work) break;
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
