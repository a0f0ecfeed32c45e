#pragma once
/// Typed values of a YAML file that is no pipeline; what is wrong is told with its place.

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "plumb/pipeline/yaml/value.hpp"

namespace plumb::experiment {

/// Reads values; of one that is none it gives what stands in for it.
class Values {
 public:
  Values(std::filesystem::path file, std::shared_ptr<const std::string> text,
         pipeline::Diagnostics& diagnostics)
      : file_(std::move(file)), text_(std::move(text)), diagnostics_(diagnostics) {}

 protected:
  using Node = pipeline::Node;

  void fault(const Origin& origin, std::string sentence, std::string hint = "") {
    diagnostics_.add(origin, std::move(sentence), std::move(hint));
  }

  /// Whether it is a map, whose keys are `known` ones.
  bool is_map(const Node& node, const std::string& what, const std::vector<std::string>& known) {
    if (!node.is_map()) {
      fault(node.origin, what + " is a map, found " + node.shown() + ".",
            "Keys: " + pipeline::joined(known) + ".");
      return false;
    }
    for (const pipeline::Entry& entry : node.entries)
      if (std::ranges::find(known, entry.key) == known.end())
        fault(entry.origin, what + " has no key '" + entry.key + "'.",
              pipeline::did_you_mean(entry.key, known));
    return true;
  }

  /// The text of a scalar; empty for what is none, which is told.
  std::string text_of(const Node& node, const std::string& what) {
    const auto text = node.is_scalar() ? pipeline::text_in(node) : std::nullopt;
    if (text && !text->empty()) return *text;
    fault(node.origin, what + " is text, found " + node.shown() + ".",
          node.is_scalar() ? pipeline::how_to_write_a_dollar : "");
    return "";
  }
  std::string text_at(const Node& map, const char* key) {
    const Node* node = map.at(key);
    return node ? text_of(*node, "'" + std::string(key) + "'") : "";
  }
  /// One text, or a list of them.
  std::vector<std::string> texts_of(const Node* node, const std::string& what) {
    if (!node) return {};
    if (!node->is_list()) return {text_of(*node, what)};
    std::vector<std::string> all;
    for (const Node& item : node->items) all.push_back(text_of(item, what));
    return all;
  }
  std::filesystem::path path_of(const std::string& text) const {
    return text.empty() ? std::filesystem::path() : (file_.parent_path() / text).lexically_normal();
  }

  std::int64_t integer_of(const Node& node, const std::string& what, double low, double high) {
    return value_of<std::int64_t>(node, what, described(ParameterKind::integer, low, high), 1);
  }
  double ratio_of(const Node& node, const std::string& what, double low, double high) {
    auto description = described(ParameterKind::number, low, high);
    description.quantity = Quantity::ratio;
    return value_of<double>(node, what, description, low);
  }
  bool boolean_of(const Node& node, const std::string& what) {
    return value_of<bool>(node, what, described(ParameterKind::boolean, 0, 1), false);
  }
  /// One of `words`; the first one instead of anything else.
  std::string word_of(const Node& node, const std::string& what,
                      const std::vector<std::string>& words) {
    auto description = described(ParameterKind::choice, 0, 0);
    for (const std::string& word : words) description.choices.push_back({word, ""});
    return value_of<std::string>(node, what, description, words.front());
  }

  /// At the first place of the file: for what it lacks.
  Origin begin() const { return {file_.string(), 1, 1}; }

  const std::filesystem::path file_;
  const std::shared_ptr<const std::string> text_;

 private:
  static ParameterDescription described(ParameterKind kind, double low, double high) {
    ParameterDescription description;
    description.kind = kind;
    description.low = low, description.high = high;
    return description;
  }
  template <class T>
  T value_of(const Node& node, const std::string& what, const ParameterDescription& description,
             T otherwise) {
    const auto value = pipeline::read_value(description, node);
    if (const auto* wrong = std::get_if<pipeline::Fault>(&value)) {
      fault(node.origin, what + ": " + wrong->sentence + ".", wrong->hint);
      return otherwise;
    }
    return std::get<T>(std::get<ParameterValue>(value));
  }

  pipeline::Diagnostics& diagnostics_;
};

}  // namespace plumb::experiment
