#include "plumb/pipeline/yaml/tree.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <map>
#include <sstream>
#include <unordered_map>

#include "plumb/pipeline/yaml/syntax.hpp"

namespace plumb::pipeline {

const Entry* Node::find(std::string_view key) const {
  for (const Entry& entry : entries)
    if (entry.key == key) return &entry;
  return nullptr;
}
Entry* Node::find(std::string_view key) {
  for (Entry& entry : entries)
    if (entry.key == key) return &entry;
  return nullptr;
}
const Node* Node::at(std::string_view key) const {
  const Entry* entry = find(key);
  return entry ? &entry->value : nullptr;
}
Node* Node::at(std::string_view key) {
  Entry* entry = find(key);
  return entry ? &entry->value : nullptr;
}
void Node::put(std::string_view key, const Origin& key_origin, Node value) {
  if (Entry* entry = find(key)) {
    entry->origin = key_origin;
    entry->value = std::move(value);
  } else {
    entries.push_back({std::string(key), key_origin, std::move(value)});
  }
}
void Node::erase(std::string_view key) {
  std::erase_if(entries, [&](const Entry& entry) { return entry.key == key; });
}
std::vector<std::string> Node::keys() const {
  std::vector<std::string> all;
  for (const Entry& entry : entries) all.push_back(entry.key);
  return all;
}
std::string Node::shown() const {
  constexpr std::size_t longest = 200;
  const std::string begin = text.size() > longest ? text.substr(0, longest) + "..." : text;
  switch (kind) {
    case Kind::none:
      return "nothing";
    case Kind::scalar:
      return quoted ? "the text \"" + begin + "\"" : "'" + begin + "'";
    case Kind::list:
      return "a list";
    case Kind::map:
      return "a map";
  }
  return "?";
}

namespace {

constexpr std::size_t most_nodes = 20000;
constexpr std::size_t most_repeated = 1 << 20;  // [byte] that aliases may stand for
constexpr std::size_t deepest = 64;

struct Stop {};  // the tree cannot be gone on with; the diagnostic is written

struct Size {
  std::size_t nodes = 0, bytes = 0;
};

/// Adds what a copy of `node` takes.
void add_size(const Node& node, Size& size) {
  ++size.nodes;
  size.bytes += node.text.size();
  for (const Node& item : node.items) add_size(item, size);
  for (const Entry& entry : node.entries) {
    size.bytes += entry.key.size();
    add_size(entry.value, size);
  }
}

void move_to(Node& node, const Origin& origin) {
  node.origin = origin;
  for (Node& item : node.items) move_to(item, origin);
  for (Entry& entry : node.entries) {
    entry.origin = origin;
    move_to(entry.value, origin);
  }
}

class Builder : public YAML::EventHandler {
 public:
  Builder(std::string file, Diagnostics& diagnostics)
      : file_(std::move(file)), diagnostics_(diagnostics) {}

  Node take() { return std::move(root_); }
  /// The innermost list or map that is not at its end, when it is written in brackets.
  std::optional<Origin> open_bracket() const {
    if (open_.empty() || !open_.back().in_brackets) return std::nullopt;
    return open_.back().node.origin;
  }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (expects_key()) stop(mark, "a key is missing here.");
    Node node;
    node.origin = origin(mark);
    attach(std::move(node), anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (expects_key()) stop(mark, "an alias cannot be a key.");
    const auto at = anchors_.find(anchor);
    if (at == anchors_.end()) stop(mark, "an alias cannot stand inside of what it names.");
    count(origin(mark), at->second);
    Node node = at->second;
    move_to(node, origin(mark));
    attach(std::move(node), 0);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_tag(mark, tag);
    if (expects_key()) {
      open_.back().key = Entry{value, origin(mark), {}};
      open_.back().has_key = true;
      return;
    }
    Node node;
    node.kind = Node::Kind::scalar;
    node.origin = origin(mark);
    node.text = value;
    node.quoted = tag != "?";
    attach(std::move(node), anchor);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value style) override {
    start(Node::Kind::list, mark, tag, anchor, style);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value style) override {
    start(Node::Kind::map, mark, tag, anchor, style);
  }
  void OnMapEnd() override { end(); }

 private:
  struct Open {
    Node node;
    YAML::anchor_t anchor;
    bool has_key = false, in_brackets = false;
    Entry key;
    std::unordered_map<std::string, Origin> keys;  ///< of a map, where each is written
  };

  Origin origin(const YAML::Mark& mark) const { return {file_, mark.line + 1, mark.column + 1}; }
  bool expects_key() const {
    return !open_.empty() && open_.back().node.is_map() && !open_.back().has_key;
  }
  [[noreturn]] void stop(const Origin& at, const char* sentence) {
    diagnostics_.add(at, sentence);
    throw Stop{};
  }
  [[noreturn]] void stop(const YAML::Mark& mark, const char* sentence) {
    stop(origin(mark), sentence);
  }
  /// Counts what is to be copied, for an alias or from one, before it is.
  void count(const Origin& at, const Node& repeated) {
    add_size(repeated, repeated_);
    if (nodes_ + repeated_.nodes > most_nodes)
      stop(at, "more than 20000 values once aliases are expanded; a pipeline is smaller.");
    if (repeated_.bytes > most_repeated)
      stop(at, "more than 1 MiB of text once aliases are expanded; a pipeline is smaller.");
  }
  void refuse_tag(const YAML::Mark& mark, const std::string& tag) {
    if (tag.empty() || tag == "?" || tag == "!") return;
    diagnostics_.add(origin(mark),
                     "the tag '" + tag + "' means nothing in a pipeline; leave it out.");
  }
  void start(Node::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
             YAML::EmitterStyle::value style) {
    if (expects_key()) stop(mark, "a key must be a plain word.");
    if (open_.size() >= deepest) stop(mark, "nested more than 64 deep.");
    refuse_tag(mark, tag);
    Open open;
    open.node.kind = kind;
    open.node.origin = origin(mark);
    open.anchor = anchor;
    open.in_brackets = style == YAML::EmitterStyle::Flow;
    open_.push_back(std::move(open));
  }
  void end() {
    Open open = std::move(open_.back());
    open_.pop_back();
    attach(std::move(open.node), open.anchor);
  }
  void attach(Node node, YAML::anchor_t anchor) {
    const Origin at = node.origin;
    if (++nodes_ + repeated_.nodes > most_nodes)
      stop(at, "more than 20000 values; a pipeline is smaller.");
    if (anchor) {
      count(at, node);
      anchors_[anchor] = node;
    }
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    Open& top = open_.back();
    if (top.node.is_list()) {
      top.node.items.push_back(std::move(node));
      return;
    }
    top.has_key = false;
    Entry entry = std::move(top.key);
    entry.value = std::move(node);
    if (entry.key == "<<") {
      diagnostics_.add(entry.origin,
                       "'<<' does not merge maps here; write the keys out, or use an overlay.");
    } else if (const auto [first, is_new] = top.keys.try_emplace(entry.key, entry.origin);
               !is_new) {
      diagnostics_.add(entry.origin, "'" + entry.key + "' is written twice.",
                       "First at " + first->second.text() + ".");
    } else {
      top.node.entries.push_back(std::move(entry));
    }
  }

  std::string file_;
  Diagnostics& diagnostics_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Node> anchors_;
  std::size_t nodes_ = 0;
  Size repeated_;  ///< by aliases
  Node root_;
};

/// Where a line opens more brackets than any tree has: the parser would hold all of them before it
/// says of one.
std::optional<Origin> too_many_brackets(const std::string& text, const std::string& file) {
  constexpr int most = 1000;
  int line = 1, column = 0, depth = 0;
  for (const char c : text) {
    ++column;
    if (c == '\n')
      ++line, column = 0, depth = 0;
    else if (c == '[' || c == '{')
      ++depth;
    else if ((c == ']' || c == '}') && depth > 0)
      --depth;
    if (depth > most) return Origin{file, line, column};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Node> parse_yaml(const std::string& text, const std::string& file,
                               Diagnostics& diagnostics) {
  diagnostics.read(file, text);
  if (const auto place = too_many_brackets(text, file)) {
    diagnostics.add(*place, "nested more than 64 deep.");
    return std::nullopt;
  }
  std::istringstream stream(text);
  Builder builder(file, diagnostics);
  const auto at = [&](const YAML::Mark& mark) {
    return Origin{file, mark.line + 1, mark.column + 1};
  };
  try {
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder)) {
      diagnostics.add({file, 1, 1}, "the file is empty.");
      return std::nullopt;
    }
    Node root = builder.take();
    Builder second(file, diagnostics);
    if (parser.HandleNextDocument(second)) {
      diagnostics.add(second.take().origin, "a second YAML document; a pipeline is one.");
      return std::nullopt;
    }
    return root;
  } catch (const Stop&) {
  } catch (const YAML::Exception& fault) {
    const bool placed = !fault.mark.is_null();
    const SyntaxFault told = syntax_fault(text, placed ? at(fault.mark) : Origin{file, 1, 1},
                                          fault.msg, builder.open_bracket());
    diagnostics.add(told.origin, told.sentence, told.hint);
  }
  return std::nullopt;
}

}  // namespace plumb::pipeline
