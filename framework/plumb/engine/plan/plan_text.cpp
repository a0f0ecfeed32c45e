#include "plumb/engine/plan/plan_text.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "plumb/data/document.hpp"
#include "plumb/engine/plan/depth.hpp"
#include "plumb/engine/plan/lifetime.hpp"
#include "plumb/pipeline/yaml/diagnostics.hpp"

namespace plumb {
namespace {

using Row = std::array<std::string, 6>;

const char* name_of(Keeping keeping) {
  switch (keeping) {
    case Keeping::passing:
      return "passing";
    case Keeping::kept:
      return "kept";
    case Keeping::remembered:
      break;
  }
  return "remembered";
}

class PlanText {
 public:
  explicit PlanText(const Plan& plan)
      : plan_(plan),
        lifetimes_(keeping_of(plan)),
        last_(last_uses(plan)),
        depths_(depths_of(plan)) {
    add_level(plan.order, "", "");
    add_groups(plan.order, "");
  }

  std::string text() const { return table() + legend + run_together() + memory; }

 private:
  static constexpr const char* legend =
      "results: passing are made anew whenever asked for, kept are made once, remembered are kept "
      "and, without a cache, looked up when the step comes again with the same inputs\n"
      "until: what asks for them last, or the step itself; in a repeat those of the last pass, "
      "others until the step comes again\n";
  static constexpr const char* memory =
      "memory: known after a first run, which ends with the most that was held during each step\n";

  /// "coarse/3" in the body of the repeat with that `path`, "3" outside of repeats.
  std::string group_of(const PlannedItem& item, const std::string& path) const {
    const int depth = item.step >= 0 ? depths_.steps[item.step] : depths_.repeats[item.repeat];
    return (path.empty() ? "" : path + "/") + std::to_string(depth);
  }

  void add_level(const std::vector<PlannedItem>& level, const std::string& path,
                 const std::string& indent) {
    for (const PlannedItem& item : level) {
      if (item.step >= 0) {
        add_step(item.step, group_of(item, path), indent);
        continue;
      }
      const PlannedRepeat& repeat = plan_.repeats[item.repeat];
      rows_.push_back({group_of(item, path), indent + repeat.path + ": " + repeat.passes_text()});
      add_level(repeat.body, repeat.path, indent + "  ");
    }
  }

  void add_groups(const std::vector<PlannedItem>& level, const std::string& path) {
    std::vector<std::string> names;  // in the order in which their first steps run
    std::map<std::string, std::vector<std::string>> groups;
    for (const PlannedItem& item : level) {
      auto& group = groups[group_of(item, path)];
      if (group.empty()) names.push_back(group_of(item, path));
      group.push_back(path_of(item));
    }
    for (const std::string& name : names)
      if (groups[name].size() > 1) groups_.push_back(name + ": " + pipeline::joined(groups[name]));
    for (const PlannedItem& item : level)
      if (item.step < 0)
        add_groups(plan_.repeats[item.repeat].body, plan_.repeats[item.repeat].path);
  }

  void add_step(int s, const std::string& group, const std::string& indent) {
    const Lifetime& lifetime = lifetimes_[s];
    rows_.push_back({group, indent + plan_.steps[s].path, seen_by(plan_.steps[s]),
                     name_of(lifetime.keeping), until(s), lifetime.why});
  }

  std::string seen_by(const PlannedStep& step) const {
    if (!step.description->itemwise()) return "whole collections";
    return "one " + step.description->items->name +
           (step.domain < 0 ? "" : " of " + plan_.steps[step.domain].path);
  }

  std::string until(int s) const {
    for (const OutputDescription& output : plan_.steps[s].description->outputs)
      if (output.type == &type_of<Document>()) return "end of run";
    return path_of(plan_.order[last_[s]]);
  }

  const std::string& path_of(const PlannedItem& item) const {
    return item.step >= 0 ? plan_.steps[item.step].path : plan_.repeats[item.repeat].path;
  }

  std::string table() const {
    std::vector<Row> rows = {{"group", "step", "one call sees", "results", "until", "why"}};
    rows.insert(rows.end(), rows_.begin(), rows_.end());
    std::array<std::size_t, 6> widths{};
    for (const Row& row : rows)
      for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
    std::string text;
    for (const Row& row : rows) {
      std::string line;
      for (std::size_t c = 0; c < row.size(); ++c)
        line += row[c] + std::string(widths[c] - row[c].size() + 2, ' ');
      text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
  }

  std::string run_together() const {
    if (groups_.empty()) return "";
    std::string text =
        "run together: none of a group waits for another, so they run at the same time where "
        "threads are free; with --memory steps run one after the other\n";
    for (const std::string& group : groups_) text += "  " + group + "\n";
    return text;
  }

  const Plan& plan_;
  const std::vector<Lifetime> lifetimes_;
  const std::vector<std::size_t> last_;
  const Depths depths_;
  std::vector<Row> rows_;
  std::vector<std::string> groups_;  ///< those with more than one in it: "3: merged, odometry"
};

}  // namespace

std::string plan_text(const Plan& plan) { return PlanText(plan).text(); }

}  // namespace plumb
