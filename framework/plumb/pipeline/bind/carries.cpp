/// What a repeat carries from pass to pass: it starts as one output and is carried on as another,
/// of one type.
#include <algorithm>

#include "plumb/pipeline/bind/binding.hpp"

namespace plumb::pipeline {

OrFaulty<std::vector<Source>> References::carried(const Node& reference, int repeat, int index) {
  Carry& carry = carries_[repeat][index];
  const bool first = !carry.looked_at;
  carry.looked_at = true;
  if (first) {
    carry.pairs = pairs_of(repeat, index);
    carry.known = true;
  }
  reading_.uses.carries.insert({repeat, index});
  Source source;
  source.wire.repeat = repeat;
  source.wire.carry = index;
  source.wire.label = reference.text;
  source.wire.origin = reference.origin;
  if (!carry.known) return std::vector<Source>{source};  // for pairs_of, which tells of it
  if (!carry.pairs) return Faulty();
  std::vector<Source> sources;
  for (const auto& [start, next] : *carry.pairs) {
    source.type = start.type;
    sources.push_back(source);
  }
  return sources;
}

/// The types that both `start` and the body's step give.
OrFaulty<References::Pairs> References::pairs_of(int repeat, int index) {
  const DeclaredRepeat& around = declared_.repeats[repeat];
  const DeclaredCarry& carry = around.passes.carries[index];
  if (!carry.start) return Faulty();
  const Node& start_node = **carry.start;
  const std::string what = "repeat '" + around.path + "': '" + carry.name + "'";
  const auto starts = sources(around.scope, start_node);
  const auto nexts = sources(around.body, *carry.next);
  if (!starts || !nexts) return Faulty();
  const auto in_body = [&](const Source& source) {
    return source.wire.step >= 0 &&
           inside(declared_, declared_.steps[source.wire.step].repeat, repeat);
  };
  if (std::any_of(starts->begin(), starts->end(), in_body)) {
    reading_.fault(start_node.origin, what + " must start with something from before the repeat.");
    return Faulty();
  }
  if (!std::all_of(nexts->begin(), nexts->end(), in_body)) {
    reading_.fault(carry.next->origin, what + " is carried on from a step of the body, and '" +
                                           carry.next->text + "' is none.");
    return Faulty();
  }
  return matched(what, *carry.next, *starts, *nexts);
}

OrFaulty<References::Pairs> References::matched(const std::string& what, const Node& next_node,
                                                const std::vector<Source>& starts,
                                                const std::vector<Source>& nexts) {
  const auto kinds_of = [](const std::vector<Source>& sources) {
    std::vector<std::string> kinds;
    kinds.reserve(sources.size());
    for (const Source& source : sources) kinds.push_back(kind_of(*source.type, source.grain));
    return joined(kinds, " and ");
  };
  Pairs pairs;
  for (const Source& start : starts)
    for (const Source& next : nexts)
      if (start.type == next.type && !start.grain && !next.grain) pairs.emplace_back(start, next);
  if (!pairs.empty()) return pairs;
  reading_.fault(
      next_node.origin,
      what + " starts as " + kinds_of(starts) + " and is carried on as " + kinds_of(nexts) + ".",
      "Both must be of one type, and one value of the whole pipeline.");
  return Faulty();
}

bool References::choose(const Source& source) {
  if (source.wire.step >= 0) {
    reading_.uses.steps.insert(source.wire.step);
    return true;
  }
  const int repeat = source.wire.repeat, index = source.wire.carry;
  Carry& carry = carries_[repeat][index];
  if (carry.chosen == source.type) return true;
  const DeclaredRepeat& around = declared_.repeats[repeat];
  const std::string& name = around.passes.carries[index].name;
  const std::string what = "'" + name + "', carried by '" + around.path + "',";
  if (carry.chosen) {
    reading_.fault(source.wire.origin,
                   what + " is " + carry.chosen->name + " elsewhere and would be " +
                       source.type->name + " here.",
                   "Name the outputs in 'start' and 'carry'.");
    return false;
  }
  const auto fits = [&](const auto& pair) { return pair.first.type == source.type; };
  const Pairs& pairs = *carry.pairs;
  if (std::count_if(pairs.begin(), pairs.end(), fits) != 1) {
    reading_.fault(source.wire.origin,
                   what + " could be several outputs of type " + source.type->name + ".",
                   "Name the outputs in 'start' and 'carry'.");
    return false;
  }
  const auto pair = std::find_if(pairs.begin(), pairs.end(), fits);
  carry.chosen = source.type;
  carry.planned = PlannedCarry{name, pair->first.wire, pair->second.wire};
  return choose(pair->first) && choose(pair->second);
}

std::vector<std::vector<OrFaulty<PlannedCarry>>> References::carries() const {
  std::vector<std::vector<OrFaulty<PlannedCarry>>> all;
  for (const auto& of_repeat : carries_) {
    auto& planned = all.emplace_back();
    for (const Carry& carry : of_repeat) planned.push_back(carry.planned);
  }
  return all;
}

}  // namespace plumb::pipeline
