#include "plumb/pipeline/bind/former.hpp"

#include "plumb/pipeline/yaml/value.hpp"

namespace plumb::pipeline {

void Reading::rename(const Node& node, const std::string& said) {
  names.note(node.origin, node.text, said);
  now[&node] = said;
}

const std::string& Reading::text_of_now(const Node& node) const {
  const auto at = now.find(&node);
  return at == now.end() ? node.text : at->second;
}

std::string setting_of_now(Reading& reading, const Settings& settings, const Node& node,
                           const std::string& name) {
  if (settings.contains(name)) return name;
  const auto now = reading.names.setting(name);
  if (!now || !settings.contains(*now)) return name;
  reading.rename(node, "$" + *now);
  return *now;
}

std::string row_or_setting_of_now(Reading& reading, const Declared& declared, const Node& node,
                                  const std::string& name, int repeat) {
  if (find_row(declared, name, repeat) || declared.settings.contains(name)) return name;
  for (int around = repeat; around >= 0; around = declared.repeats[around].parent) {
    const std::string scope = declared.repeats[around].path + ".";
    const auto row = reading.names.setting(scope + name);
    if (!row || !row->starts_with(scope)) continue;
    const std::string now = row->substr(scope.size());
    if (!find_row(declared, now, around)) continue;
    reading.rename(node, "$" + now);
    return now;
  }
  return setting_of_now(reading, declared.settings, node, name);
}

namespace {

class Choices {
 public:
  Choices(Reading& reading, const StepDescription& step, const ParameterDescription& parameter)
      : reading_(reading), step_(step), parameter_(parameter) {}

  bool note(const Node& node) { return note(node, node.text); }

  void note_in(const DeclaredRow& row) {
    for (const Node* value : row.values) note(*value, reading_.text_of_now(*value));
  }

  void note_in(const Setting& setting) {
    if (!setting.value || !setting.value->written || !note(*setting.value->written)) return;
    if (const Node* of = setting.node->at("of"))
      for (const Node& item : of->items) note(item);
  }

 private:
  /// Of a node that says `text`, perhaps by what another step noted. False when it is no former
  /// name.
  bool note(const Node& node, const std::string& text) {
    if (!node.is_scalar()) return false;
    const auto now = reading_.names.choice(step_, parameter_, text);
    if (now) reading_.rename(node, *now);
    return now.has_value();
  }

  Reading& reading_;
  const StepDescription& step_;
  const ParameterDescription& parameter_;
};

}  // namespace

void note_choices(Reading& reading, const Declared& declared, int step,
                  const ParameterDescription& parameter, const Node& node) {
  if (parameter.kind != ParameterKind::choice) return;
  const DeclaredStep& given = declared.steps[step];
  Choices choices(reading, *given.use->description, parameter);
  const auto reference = reference_in(node);
  if (!reference) {
    choices.note(node);
    return;
  }
  const std::string name = row_or_setting_of_now(reading, declared, node, *reference, given.repeat);
  if (const auto row = find_row(declared, name, given.repeat))
    choices.note_in(declared.repeats[row->first].passes.rows[row->second]);
  else if (const auto setting = declared.settings.find(name); setting != declared.settings.end())
    choices.note_in(setting->second);
}

Node tree_of_now(const Node& tree, const NamesOfNow& now) {
  const auto at = now.find(&tree);
  Node copy;
  copy.kind = tree.kind;
  copy.origin = tree.origin;
  copy.text = at == now.end() ? tree.text : at->second;
  copy.quoted = tree.quoted;
  copy.items.reserve(tree.items.size());
  for (const Node& item : tree.items) copy.items.push_back(tree_of_now(item, now));
  copy.entries.reserve(tree.entries.size());
  for (const Entry& entry : tree.entries)
    copy.entries.push_back({entry.key, entry.origin, tree_of_now(entry.value, now)});
  return copy;
}

}  // namespace plumb::pipeline
