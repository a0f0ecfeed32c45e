/// The pipeline that results, as YAML, each value with the place that it came from.
#include "plumb/pipeline/print/resolved.hpp"

#include <algorithm>
#include <set>

#include "plumb/data/io/plain_text.hpp"
#include "plumb/pipeline/bind/former.hpp"
#include "plumb/pipeline/yaml/parts.hpp"
#include "plumb/pipeline/yaml/value.hpp"

namespace plumb::pipeline {
namespace {

bool needs_quotes(const std::string& text, bool in_flow) {
  if (text.empty() || text.front() == ' ' || text.back() == ' ' || text.back() == ':') return true;
  if (std::string_view("?:,[]{}#&*!|>'\"%@`").find(text.front()) != std::string_view::npos)
    return true;
  if (text.front() == '-' &&
      (text.size() == 1 || !std::isdigit(static_cast<unsigned char>(text[1]))))
    return true;
  if (text == "~" || text == "null" || text == "Null" || text == "NULL") return true;
  if (text.find(": ") != std::string::npos || text.find(" #") != std::string::npos) return true;
  if (io::plain(text) != text) return true;
  return in_flow && text.find_first_of(",[]{}") != std::string::npos;
}

std::string scalar(const std::string& text, bool was_quoted, bool in_flow) {
  return was_quoted || needs_quotes(text, in_flow) ? io::plain_in_quotes(text) : text;
}

/// As it is written; in quotes, where each '$' stands for itself, the text that it means.
std::string scalar(const Node& node, bool in_flow) {
  if (node.quoted || !needs_quotes(node.text, in_flow))
    return scalar(node.text, node.quoted, in_flow);
  return io::plain_in_quotes(text_in(node).value_or(node.text));
}

/// Text that is no reference, whatever is in it.
std::string words(const std::string& text, bool was_quoted) {
  return scalar(text, was_quoted || text.find('$') != std::string::npos, false);
}

/// As plumb::written, but so that it reads back as the same value.
std::string exactly(const ParameterDescription& parameter, const ParameterValue& value) {
  const auto* si = std::get_if<double>(&value);
  const std::string text = written(parameter, value);
  if (!si || parameter.quantity == Quantity::none) return text;
  for (const Unit& unit : units()) {
    if (unit.quantity != parameter.quantity) continue;
    for (const std::string& tried : {text, shortest(*si / unit.factor) + " " + unit.symbol}) {
      const auto number = read_number(tried);
      const auto* measured = std::get_if<Measured>(&number);
      if (measured && measured->si == *si) return tried;
    }
  }
  return text;
}

std::string flow(const Node& node) {  // NOLINT: as deep as the tree, at most 64
  std::string text;
  switch (node.kind) {
    case Node::Kind::none:
      return "";
    case Node::Kind::scalar:
      return scalar(node, true);
    case Node::Kind::list:
      for (const Node& item : node.items) text += (text.empty() ? "" : ", ") + flow(item);
      return "[" + text + "]";
    case Node::Kind::map:
      for (const Entry& entry : node.entries)
        text +=
            (text.empty() ? "" : ", ") + scalar(entry.key, false, true) + ": " + flow(entry.value);
      return "{" + text + "}";
  }
  return text;
}

/// The step or repeat of that path.
const Node& node_at(const Node& tree, const std::string& path) {
  const Node* at = &tree;
  for (const std::string& name : parts_of(path)) at = at->at("steps")->at(name);
  return *at;
}

class Writer {
 public:
  explicit Writer(const Bound& bound)
      : bound_(bound), tree_(tree_of_now(bound.declared.loaded->tree, bound.now)) {
    const Declared& declared = bound.declared;
    for (std::size_t k = 0; k < declared.steps.size(); ++k)
      step_of_[&node_at(tree_, declared.steps[k].path)] = static_cast<int>(k);
    for (const auto& [name, setting] : declared.settings)
      if (!bound.uses.settings.contains(name)) unused_.insert(tree_.at("parameters")->at(name));
    for (std::size_t r = 0; r < declared.repeats.size(); ++r) note_unused_rows(static_cast<int>(r));
  }

  std::string write() {
    map(tree_, 0);
    return std::move(text_);
  }

 private:
  void note_unused_rows(int repeat) {
    const DeclaredRepeat& declared = bound_.declared.repeats[repeat];
    const auto& rows = declared.passes.rows;
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (!bound_.uses.rows.contains({repeat, static_cast<int>(k)}))
        unused_.insert(node_at(tree_, declared.path).at("repeat")->at("passes")->at(rows[k].name));
  }

  void line(int depth, const std::string& content, const std::string& comment) {
    text_ += std::string(2 * depth, ' ') + content;
    if (!comment.empty()) {
      const std::size_t width = 2 * depth + content.size();
      std::string safe = comment;
      std::replace_if(
          safe.begin(), safe.end(), [](unsigned char c) { return c < 0x20; }, ' ');
      text_ += std::string(width < 58 ? 58 - width : 2, ' ') + "# " + safe;
    }
    text_ += "\n";
  }

  void map(const Node& node, int depth) {
    const auto step = step_of_.find(&node);
    for (const Entry& entry : node.entries) {
      const bool with = step != step_of_.end() && entry.key == "with";
      const std::string key = scalar(entry.key, false, false) + ":";
      if (entry.value.is_map() && unused_.contains(&entry.value)) {
        // A file that declares what it does not use would be refused.
        line(depth, "# " + key + " " + flow(entry.value), nothing_uses_it);
      } else if (entry.value.is_map() && !entry.value.entries.empty() &&
                 std::ranges::all_of(entry.value.entries, [&](const Entry& inner) {
                   return inner.value.is_map() && unused_.contains(&inner.value);
                 })) {
        line(depth, key + " {}", "");
      } else if (entry.value.is_map() && entry.key != "from" && entry.key != "start" &&
                 entry.key != "carry" && entry.key != "until") {
        line(depth, key, "");
        if (with)
          parameters(entry.value, step->second, depth + 1);
        else
          map(entry.value, depth + 1);
      } else {
        std::string comment = entry.value.origin.text();
        if (unused_.contains(&entry.value)) comment += std::string(", ") + nothing_uses_it;
        line(depth, key + " " + value(node, entry), comment);
      }
    }
    if (step != step_of_.end() && !node.at("with") &&
        !bound_.steps[step->second].value().parameters.empty()) {
      line(depth, "with:", "");
      parameters({}, step->second, depth + 1);
    }
  }

  std::string value(const Node& around, const Entry& entry) const {
    const Node* type = around.at("type");
    if (entry.key == "default" && type && type->text == "path" && entry.value.text != "none")
      if (const auto path = absolute(entry.value)) return *path;
    return entry.value.is_scalar() ? scalar(entry.value, false) : flow(entry.value);
  }

  static std::optional<std::string> absolute(const Node& node) {
    ParameterDescription type;
    type.kind = ParameterKind::path;
    auto value = read_value(type, node);
    if (const auto* read = std::get_if<ParameterValue>(&value))
      return words(std::get<std::string>(*read), node.quoted);
    return std::nullopt;
  }

  /// A step's parameters, those at their defaults too, in the order declared.
  void parameters(const Node& with, int index, int depth) {
    const BoundStep& step = bound_.steps[index].value();
    for (std::size_t k = 0; k < step.parameters.size(); ++k) {
      const ParameterDescription& description = step.description->parameters[k];
      const PlannedParameter& planned = step.parameters[k].value();
      const Node* node = with.at(description.name);
      if (!node) {
        const bool is_text = description.kind == ParameterKind::text ||
                             description.kind == ParameterKind::path ||
                             description.kind == ParameterKind::choice;
        const bool none = std::holds_alternative<std::monostate>(planned.value);
        const std::string text = exactly(description, planned.value);
        if (description.required) continue;
        line(depth, description.name + ": " + words(text, is_text && !none && text == "none"),
             "default of " + step.description->name);
        continue;
      }
      std::string text = node->is_scalar() ? scalar(*node, false) : flow(*node);
      if (description.kind == ParameterKind::path && !reference_in(*node) &&
          !std::holds_alternative<std::monostate>(planned.value))
        text = words(std::get<std::string>(planned.value), node->quoted);
      std::string origin = node->origin.text();
      if (reference_in(*node) && planned.repeat < 0)
        origin += ": " + written(description, planned.value) + ", " + planned.origin.text();
      line(depth, description.name + ": " + text, origin);
    }
  }

  static constexpr const char* nothing_uses_it = "nothing uses it any more";
  const Bound& bound_;
  const Node tree_;  ///< by the names of now
  std::map<const Node*, int> step_of_;
  std::set<const Node*> unused_;  ///< parameters and rows that an overlay left without a use
  std::string text_;
};

}  // namespace

std::string resolved_text(const Bound& bound) { return Writer(bound).write(); }

}  // namespace plumb::pipeline
