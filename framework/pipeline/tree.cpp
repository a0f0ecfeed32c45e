#include "plumb/pipeline/tree.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <map>
#include <sstream>

#include "plumb/pipeline/syntax.hpp"

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
  switch (kind) {
    case Kind::none:
      return "nothing";
    case Kind::scalar:
      return quoted ? "the text \"" + text + "\"" : "'" + text + "'";
    case Kind::list:
      return "a list";
    case Kind::map:
      return "a map";
  }
  return "?";
}

namespace {

constexpr std::size_t most_nodes = 20000;
constexpr std::size_t deepest = 64;

struct Stop {};  // the tree cannot be gone on with; the diagnostic is written

std::size_t size_of(const Node& node) {
  std::size_t n = 1;
  for (const Node& item : node.items) n += size_of(item);
  for (const Entry& entry : node.entries) n += size_of(entry.value);
  return n;
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
    count(mark, size_of(at->second));
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
  };

  Origin origin(const YAML::Mark& mark) const { return {file_, mark.line + 1, mark.column + 1}; }
  bool expects_key() const {
    return !open_.empty() && open_.back().node.is_map() && !open_.back().has_key;
  }
  [[noreturn]] void stop(const YAML::Mark& mark, const char* sentence) {
    diagnostics_.add(origin(mark), sentence);
    throw Stop{};
  }
  void count(const YAML::Mark& mark, std::size_t more) {
    nodes_ += more;
    if (nodes_ > most_nodes)
      stop(mark, "more than 20000 values once aliases are expanded; a pipeline is smaller.");
  }
  void refuse_tag(const YAML::Mark& mark, const std::string& tag) {
    if (tag.empty() || tag == "?" || tag == "!") return;
    diagnostics_.add(origin(mark),
                     "the tag '" + tag + "' means nothing in a pipeline; leave it out.");
  }
  void start(Node::Kind kind, const YAML::Mark& mark, const std::string& tag,
             YAML::anchor_t anchor, YAML::EmitterStyle::value style) {
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
    if (++nodes_ > most_nodes) {
      diagnostics_.add(at, "more than 20000 values; a pipeline is smaller.");
      throw Stop{};
    }
    if (anchor) anchors_[anchor] = node;
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
    } else if (const Entry* first = top.node.find(entry.key)) {
      diagnostics_.add(entry.origin, "'" + entry.key + "' is written twice.",
                       "First at " + first->origin.text() + ".");
    } else {
      top.node.entries.push_back(std::move(entry));
    }
  }

  std::string file_;
  Diagnostics& diagnostics_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Node> anchors_;
  std::size_t nodes_ = 0;
  Node root_;
};

}  // namespace

std::optional<Node> parse_yaml(const std::string& text, const std::string& file,
                               Diagnostics& diagnostics) {
  diagnostics.read(file, text);
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
