#pragma once
/// YAML as a tree in which every key and every value knows where it was written.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/pipeline/yaml/diagnostics.hpp"

namespace plumb::pipeline {

struct Entry;

/// A scalar, a list or a map; `none` where nothing (or null) is written.
struct Node {
  enum class Kind { none, scalar, list, map };
  Kind kind = Kind::none;
  Origin origin;
  std::string text;         ///< of a scalar
  bool quoted = false;      ///< a scalar in quotes or a block: text, never a number or a reference
  std::vector<Node> items;  ///< of a list
  std::vector<Entry> entries;  ///< of a map, in the order written

  bool is_scalar() const { return kind == Kind::scalar; }
  bool is_list() const { return kind == Kind::list; }
  bool is_map() const { return kind == Kind::map; }
  const Entry* find(std::string_view key) const;
  Entry* find(std::string_view key);
  /// The value under a key, or null.
  const Node* at(std::string_view key) const;
  Node* at(std::string_view key);
  /// Puts a value under a key: in the place of an earlier one, or at the end.
  void put(std::string_view key, const Origin& key_origin, Node value);
  void erase(std::string_view key);
  /// The keys of a map.
  std::vector<std::string> keys() const;
  /// What is there, for sentences: "a list", "'0.3 m'".
  std::string shown() const;
};

struct Entry {
  std::string key;
  Origin origin;
  Node value;
};

/// Reads one YAML document. Refused, with a diagnostic: duplicate keys, `<<`, tags, keys that are
/// not scalars, several documents, and more than 20,000 nodes or 1 MiB more text than was given
/// once aliases are expanded. What an alias stands for gets the place of its use. Returns nothing
/// when there is no tree to go on with.
std::optional<Node> parse_yaml(const std::string& text, const std::string& file,
                               Diagnostics& diagnostics);

}  // namespace plumb::pipeline
