/// Puts steps and repeats into an order in which they can run, level by level; or names the cycle.
#include <algorithm>
#include <set>

#include "plumb/pipeline/check/checks.hpp"

namespace plumb::pipeline {
namespace {

/// The steps and repeats directly in one repeat's body, or in the pipeline (-1).
struct Level {
  struct Item {
    PlannedItem item;
    int sequence;
    std::set<int> needs, serves;  // other items of this level
    Origin origin;                // where it is written
    std::string path;
  };
  std::vector<Item> items;
};

class Levels {
 public:
  Levels(const Bound& bound, Diagnostics& diagnostics)
      : declared_(bound.declared),
        diagnostics_(diagnostics),
        levels_(declared_.repeats.size() + 1),
        of_step_(declared_.steps.size()),
        of_repeat_(declared_.repeats.size()) {
    for (std::size_t k = 0; k < declared_.steps.size(); ++k) {
      const DeclaredStep& step = declared_.steps[k];
      auto& items = level(step.repeat).items;
      of_step_[k] = static_cast<int>(items.size());
      items.push_back({{static_cast<int>(k), -1}, step.sequence, {}, {}, step.origin, step.path});
    }
    for (std::size_t k = 0; k < declared_.repeats.size(); ++k) {
      const DeclaredRepeat& repeat = declared_.repeats[k];
      auto& items = level(repeat.parent).items;
      of_repeat_[k] = static_cast<int>(items.size());
      items.push_back(
          {{-1, static_cast<int>(k)}, repeat.sequence, {}, {}, repeat.origin, repeat.path});
    }
    connect_all(bound);
  }

  Order order() const {
    Order order{sorted(level(-1)), {}};
    order.bodies.reserve(declared_.repeats.size());
    for (std::size_t k = 0; k < declared_.repeats.size(); ++k)
      order.bodies.push_back(sorted(level(static_cast<int>(k))));
    return order;
  }

 private:
  Level& level(int repeat) { return levels_[repeat + 1]; }
  const Level& level(int repeat) const { return levels_[repeat + 1]; }

  void connect_all(const Bound& bound) {
    for (std::size_t k = 0; k < bound.steps.size(); ++k) {
      if (!bound.steps[k]) continue;
      for (const auto& wires : bound.steps[k]->inputs)
        for (const OrFaulty<Wire>& wire : wires)
          if (wire) connect(*wire, declared_.steps[k].repeat, of_step_[k]);
    }
    for (std::size_t k = 0; k < bound.repeats.size(); ++k)
      for (const OrFaulty<PlannedCarry>& carry : bound.repeats[k].carries)
        if (carry) connect(carry->start, declared_.repeats[k].parent, of_repeat_[k]);
  }

  /// The item that a step belongs to, as seen from a level around it.
  int item_at(int step, int repeat) const {
    int at = declared_.steps[step].repeat;
    if (at == repeat) return of_step_[step];
    while (declared_.repeats[at].parent != repeat) at = declared_.repeats[at].parent;
    return of_repeat_[at];
  }

  /// `item` of level `repeat` needs what `wire` brings: on the innermost level that both lie in.
  void connect(const Wire& wire, int repeat, int item) {
    if (wire.step < 0) return;
    while (!inside(declared_, declared_.steps[wire.step].repeat, repeat)) {
      item = of_repeat_[repeat];
      repeat = declared_.repeats[repeat].parent;
    }
    const int from = item_at(wire.step, repeat);
    level(repeat).items[item].needs.insert(from);
    level(repeat).items[from].serves.insert(item);
  }

  std::vector<PlannedItem> sorted(const Level& at) const {
    std::vector<PlannedItem> order;
    std::set<std::pair<int, int>> ready;  // by sequence: as written, wherever that can be
    std::vector<std::size_t> waiting(at.items.size());
    for (std::size_t k = 0; k < at.items.size(); ++k) {
      waiting[k] = at.items[k].needs.size();
      if (waiting[k] == 0) ready.insert({at.items[k].sequence, static_cast<int>(k)});
    }
    while (!ready.empty()) {
      const int k = ready.begin()->second;
      ready.erase(ready.begin());
      order.push_back(at.items[k].item);
      for (const int next : at.items[k].serves)
        if (--waiting[next] == 0) ready.insert({at.items[next].sequence, next});
    }
    if (order.size() < at.items.size()) name_cycle(at, waiting);
    return order;
  }

  void name_cycle(const Level& at, const std::vector<std::size_t>& waiting) const {
    int k = 0;
    while (waiting[k] == 0) ++k;
    std::vector<int> walk;
    while (std::find(walk.begin(), walk.end(), k) == walk.end()) {
      walk.push_back(k);
      for (const int before : at.items[k].needs)
        if (waiting[before] > 0) {
          k = before;
          break;
        }
    }
    walk.erase(walk.begin(), std::find(walk.begin(), walk.end(), k));
    std::reverse(walk.begin(), walk.end());
    // Told from the item that is written first.
    const auto first = std::min_element(walk.begin(), walk.end(), [&](int a, int b) {
      return at.items[a].sequence < at.items[b].sequence;
    });
    std::rotate(walk.begin(), first, walk.end());
    std::string text;
    for (const int item : walk) text += at.items[item].path + " -> ";
    const auto& item = at.items[walk.front()];
    diagnostics_.add(item.origin, "these steps wait for each other: " + text + item.path + ".",
                     "A loop is a 'repeat' that carries a value from pass to pass.");
  }

  const Declared& declared_;
  Diagnostics& diagnostics_;
  std::vector<Level> levels_;
  std::vector<int> of_step_, of_repeat_;
};

}  // namespace

Order order_of(const Bound& bound, Diagnostics& diagnostics) {
  return Levels(bound, diagnostics).order();
}

}  // namespace plumb::pipeline
