#include "plumb/pipeline/yaml/rewritten.hpp"

#include <algorithm>
#include <map>

#include "plumb/pipeline/yaml/tree.hpp"

namespace plumb::pipeline {
namespace {

constexpr auto npos = std::string::npos;

struct Edit {
  std::size_t at, length;
  std::string text;
};

/// A scalar as it is written.
struct Token {
  std::size_t at, length;  ///< without its quotes
  std::size_t end;         ///< behind them
};

/// The step of this place.
const Entry* step_at(const Node& node, const Origin& origin) {
  for (const Entry& entry : node.entries) {
    if (entry.origin.line == origin.line && entry.origin.column == origin.column) return &entry;
    if (const Entry* inner = step_at(entry.value, origin)) return inner;
  }
  return nullptr;
}

class Rewriter {
 public:
  Rewriter(const std::string& text, const std::string& file, Diagnostics& diagnostics)
      : text_(text), file_(file), diagnostics_(diagnostics) {}

  std::string of(const std::vector<Renaming>& renamings) {
    std::map<std::pair<int, int>, std::vector<Renaming>> defaults;  // by step
    for (const Renaming& renaming : renamings)
      if (renaming.kind == Renaming::Kind::text)
        replace(renaming);
      else
        defaults[{renaming.origin.line, renaming.origin.column}].push_back(renaming);
    const auto tree = defaults.empty() ? std::nullopt : parse_yaml(text_, file_, diagnostics_);
    if (tree)
      for (const auto& [place, of_step] : defaults) write_out(*tree, of_step);
    std::stable_sort(edits_.begin(), edits_.end(),
                     [](const Edit& a, const Edit& b) { return a.at > b.at; });
    std::string result = text_;
    for (const Edit& edit : edits_) result.replace(edit.at, edit.length, edit.text);
    return result;
  }

 private:
  std::size_t offset(const Origin& place) const {
    std::size_t at = 0;
    for (int line = 1; line < place.line; ++line) {
      at = text_.find('\n', at);
      if (at == npos) return npos;
      ++at;
    }
    at += static_cast<std::size_t>(place.column - 1);
    return at <= text_.size() ? at : npos;
  }

  /// Behind an anchor that stands at `at`.
  std::size_t behind_anchor(std::size_t at) const {
    if (at == npos || at >= text_.size() || text_[at] != '&') return at;
    return text_.find_first_not_of(" \t", text_.find_first_of(" \t\r\n", at));
  }

  std::optional<Token> token(const Origin& place, const std::string& word) const {
    std::size_t at = behind_anchor(offset(place));
    if (at == npos || at >= text_.size()) return std::nullopt;
    const std::size_t quotes = text_[at] == '"' || text_[at] == '\'' ? 1 : 0;
    const char quote = text_[at];
    at += quotes;
    if (text_.compare(at, word.size(), word) != 0) return std::nullopt;
    const std::size_t end = at + word.size();
    const char next = end < text_.size() ? text_[end] : '\n';
    if (quotes ? next != quote : std::string_view(" \t\r\n,:]}").find(next) == npos)
      return std::nullopt;
    return Token{at, word.size(), end + quotes};
  }

  void cannot(const Origin& place, const std::string& what) {
    const std::size_t at = offset(place);
    const bool alias = at < text_.size() && text_[at] == '*';
    diagnostics_.add(
        place,
        what + " cannot be written here" + (alias ? ", behind an alias." : "; write it yourself."),
        alias ? "Write out here what the alias stands for, then migrate." : "");
  }

  void replace(const Renaming& renaming) {
    if (const auto found = token(renaming.origin, renaming.was))
      edits_.push_back({found->at, found->length, renaming.now});
    else
      cannot(renaming.origin, "'" + renaming.now + "' for '" + renaming.was + "'");
  }

  /// The former defaults of one step.
  void write_out(const Node& tree, const std::vector<Renaming>& defaults) {
    const Entry* step = step_at(tree, defaults.front().origin);
    const Node* with = step ? step->value.at("with") : nullptr;
    std::vector<std::string> entries;
    entries.reserve(defaults.size());
    for (const Renaming& each : defaults) entries.push_back(each.was + ": " + each.now);
    const bool written = step && (with ? add_to_map(*with, entries) : add_with(*step, entries));
    if (!written) cannot(defaults.front().origin, "'" + joined(entries) + "'");
  }

  bool add_to_map(const Node& with, const std::vector<std::string>& entries) {
    const std::size_t at = behind_anchor(offset(with.origin));
    if (at == npos || at >= text_.size() || text_[at] == '*') return false;
    const bool flow = text_[at] == '{';
    if (with.entries.empty()) {
      if (flow) edits_.push_back({at + 1, 0, joined(entries)});
      return flow;
    }
    const Origin& first = with.entries.front().origin;
    const std::string between = flow ? ", " : line_end() + std::string(first.column - 1, ' ');
    edits_.push_back({offset(first), 0, joined(entries, between.c_str()) + between});
    return true;
  }

  /// Right behind the step's 'use'.
  bool add_with(const Entry& step, const std::vector<std::string>& entries) {
    const std::size_t at = behind_anchor(offset(step.value.origin));
    const Entry* use = step.value.find("use");
    const auto found = use ? token(use->value.origin, use->value.text) : std::nullopt;
    if (!found || at == npos || text_[at] == '*') return false;
    const std::string with = "with: {" + joined(entries) + "}";
    if (text_[at] == '{') {
      edits_.push_back({found->end, 0, ", " + with});
      return true;
    }
    std::size_t end = std::min(text_.find('\n', found->end), text_.size());
    if (end > 0 && text_[end - 1] == '\r') --end;
    edits_.push_back({end, 0, line_end() + std::string(use->origin.column - 1, ' ') + with});
    return true;
  }

  std::string line_end() const { return text_.find("\r\n") == npos ? "\n" : "\r\n"; }

  const std::string& text_;
  const std::string& file_;
  Diagnostics& diagnostics_;
  std::vector<Edit> edits_;
};

}  // namespace

std::string rewritten(const std::string& text, const std::string& file,
                      const std::vector<Renaming>& renamings, Diagnostics& diagnostics) {
  return Rewriter(text, file, diagnostics).of(renamings);
}

}  // namespace plumb::pipeline
