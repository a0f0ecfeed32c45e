/// What a step says in former words, found when it is bound: outputs, choices, and the rows and
/// parameters of our own pipelines.
#include "plumb/pipeline/bind/draft.hpp"

namespace plumb::pipeline {

void rename(Draft& draft, const Node& node, const std::string& now) {
  draft.names.note(node.origin, node.text, now);
  draft.rewritten[&node] = now;
}

const std::string& text_of_now(const Draft& draft, const Node& node) {
  const auto at = draft.rewritten.find(&node);
  return at == draft.rewritten.end() ? node.text : at->second;
}

std::string setting_of_now(Draft& draft, const Node& node, const std::string& name, int repeat) {
  if (find_row(draft, name, repeat) || draft.settings.contains(name)) return name;
  for (int around = repeat; around >= 0; around = draft.repeats[around].parent) {
    const std::string scope = draft.plan.repeats[around].path + ".";
    const auto row = draft.names.setting(scope + name);
    if (!row || !row->starts_with(scope)) continue;
    const std::string now = row->substr(scope.size());
    if (!find_row(draft, now, around)) continue;
    rename(draft, node, "$" + now);
    return now;
  }
  const auto now = draft.names.setting(name);
  if (!now || !draft.settings.contains(*now)) return name;
  rename(draft, node, "$" + *now);
  return *now;
}

namespace {

class Choices {
 public:
  Choices(Draft& draft, int step, const ParameterDescription& parameter)
      : draft_(draft), step_(*draft.plan.steps[step].description), parameter_(parameter) {}

  const Node& of_now(const Node& node) {
    const auto now =
        node.is_scalar() ? draft_.names.choice(step_, parameter_, node.text) : std::nullopt;
    if (!now) return node;
    rename(draft_, node, *now);
    draft_.renamed.push_back(node);
    draft_.renamed.back().text = *now;
    return draft_.renamed.back();
  }

  void in_row(int repeat, int row) {
    for (const Node*& value : draft_.repeats[repeat].rows[row].values) value = &of_now(*value);
  }

  void in_setting(const std::string& name) {
    const auto setting = draft_.settings.find(name);
    const Node* declared = draft_.tree.at("parameters")->at(name);
    const Node* value = declared ? declared->at("default") : nullptr;
    if (setting == draft_.settings.end() || setting->second.faulty || !value) return;
    const Node& now = of_now(*value);
    if (&now == value) return;
    setting->second.value = now.text;
    if (const Node* of = declared->at("of"))
      for (const Node& item : of->items) of_now(item);
  }

 private:
  Draft& draft_;
  const StepDescription& step_;
  const ParameterDescription& parameter_;
};

void rewrite(Node& node, const std::map<const Node*, std::string>& rewritten) {
  if (const auto at = rewritten.find(&node); at != rewritten.end()) node.text = at->second;
  for (Node& item : node.items) rewrite(item, rewritten);
  for (Entry& entry : node.entries) rewrite(entry.value, rewritten);
}

}  // namespace

const Node& choice_of_now(Draft& draft, int step, const ParameterDescription& parameter,
                          const Node& node) {
  if (parameter.kind != ParameterKind::choice) return node;
  Choices choices(draft, step, parameter);
  const auto reference = reference_in(node);
  if (!reference) return choices.of_now(node);
  const int repeat = draft.steps[step].repeat;
  const std::string name = setting_of_now(draft, node, *reference, repeat);
  if (const auto row = find_row(draft, name, repeat))
    choices.in_row(row->first, row->second);
  else if (draft.settings.contains(name))
    choices.in_setting(name);
  return node;
}

void rewrite(Draft& draft) {
  if (!draft.rewritten.empty()) rewrite(draft.tree, draft.rewritten);
}

}  // namespace plumb::pipeline
