/// What a repeat says of its passes: rows, carried values, how many.
#include <algorithm>

#include "plumb/pipeline/bind/draft.hpp"

namespace plumb::pipeline {
namespace {

class Passes {
 public:
  Passes(Draft& draft, int index)
      : draft_(draft),
        index_(index),
        planned_(draft.plan.repeats[index]),
        what_("repeat '" + planned_.path + "'") {}

  void read() {
    const Node& node = *draft_.repeats[index_].node;
    check_keys(draft_, node, what_, {"repeat", "start", "steps"});
    const Node& repeat = *node.at("repeat");
    if (!check_keys(draft_, repeat, what_,
                    {"passes", "carry", "until", "at_least", "at_most", "if_exhausted"}))
      return;
    read_rows(repeat);
    read_carries(repeat, node.at("start"));
    read_counts(repeat);
    read_exhausted(repeat);
  }

 private:
  void read_rows(const Node& repeat) {
    const Node* passes = repeat.at("passes");
    if (!passes) return;
    if (!passes->is_map())
      return draft_.fault(passes->origin,
                          what_ + ": 'passes' is a map of rows, found " + passes->shown() + ".");
    std::string longest;
    for (const Entry& entry : passes->entries) {
      DraftRow row;
      if (entry.value.is_list())
        for (const Node& item : entry.value.items) row.values.push_back(&item);
      else
        row.values.push_back(&entry.value);
      const int columns = static_cast<int>(row.values.size());
      const std::string name = what_ + ": the row '" + entry.key + "'";
      if (!valid_name(entry.key))
        draft_.fault(entry.origin,
                     name + " has no valid name: letters, digits and '_', a letter first.");
      if (columns == 0) draft_.fault(entry.origin, name + " is empty.");
      refuse_shadow(entry, name);
      if (columns > 1 && planned_.passes > 1 && columns != planned_.passes)
        draft_.fault(entry.value.origin,
                     name + " has " + std::to_string(columns) + " values, '" + longest + "' has " +
                         std::to_string(planned_.passes) + ".",
                     "Rows are equally long, or one value for all passes.");
      else if (columns > 1)
        planned_.passes = columns, longest = entry.key;
      planned_.rows.push_back(
          {entry.key, {}, ParameterKind::number, Quantity::none, entry.value.origin});
      draft_.repeats[index_].rows.push_back(std::move(row));
    }
  }

  void refuse_shadow(const Entry& row, const std::string& name) {
    const auto setting = draft_.settings.find(row.key);
    if (setting != draft_.settings.end())
      draft_.fault(row.origin, name + " has the name of a parameter of the pipeline.",
                   "That is at " + setting->second.declared.text() + ".");
    for (int outer = draft_.repeats[index_].parent; outer >= 0;
         outer = draft_.repeats[outer].parent)
      for (const PlannedRow& other : draft_.plan.repeats[outer].rows)
        if (other.name == row.key)
          draft_.fault(row.origin, name + " has the name of an outer row.",
                       "That is at " + other.origin.text() + ".");
  }

  void read_carries(const Node& repeat, const Node* start) {
    const Node* carry = repeat.at("carry");
    if (carry && !carry->is_map())
      return draft_.fault(carry->origin,
                          what_ + ": 'carry' is a map, found " + carry->shown() + ".");
    if (start && !start->is_map())
      return draft_.fault(start->origin,
                          what_ + ": 'start' is a map, found " + start->shown() + ".");
    if (start)
      for (const Entry& entry : start->entries)
        if (!carry || !carry->find(entry.key))
          draft_.fault(entry.origin,
                       what_ + ": 'start' names '" + entry.key + "', which is not carried.",
                       did_you_mean(entry.key, carry ? carry->keys() : std::vector<std::string>()));
    if (!carry) return;
    for (const Entry& entry : carry->entries) {
      const Symbol symbol{Symbol::Kind::carry,
                          static_cast<int>(draft_.repeats[index_].carries.size()), entry.origin};
      if (!declare(draft_, draft_.repeats[index_].body, entry.key, symbol)) continue;
      DraftCarry drafted;
      drafted.next = &entry.value;
      drafted.start = start ? start->at(entry.key) : nullptr;
      if (!drafted.start)
        draft_.fault(
            entry.origin,
            what_ + ": '" + entry.key +
                "' is carried, but 'start' does not say what it is before the first pass.");
      PlannedCarry planned;
      planned.name = entry.key;
      planned.start.origin = drafted.start ? drafted.start->origin : entry.origin;
      planned.next.origin = entry.value.origin;
      draft_.plan.repeats[index_].carries.push_back(std::move(planned));
      draft_.repeats[index_].carries.push_back(drafted);
    }
  }

  std::optional<int> count(const Node& repeat, const char* key) {
    const Node* node = repeat.at(key);
    if (!node) return std::nullopt;
    ParameterDescription type;
    type.name = key;
    type.kind = ParameterKind::integer;
    type.low = 1;
    type.high = 1000;
    const auto value = value_of(draft_, what_ + ": '" + key + "'", type, *node, -1, nullptr);
    if (!value || !std::holds_alternative<std::int64_t>(*value)) return std::nullopt;
    return static_cast<int>(std::get<std::int64_t>(*value));
  }

  void read_counts(const Node& repeat) {
    const Node* until = repeat.at("until");
    for (const char* key : {"at_least", "if_exhausted"})
      if (!until && repeat.at(key))
        draft_.fault(repeat.find(key)->origin,
                     what_ + ": '" + key + "' means nothing without 'until'.");
    const auto at_least = count(repeat, "at_least"), at_most = count(repeat, "at_most");
    planned_.at_most = at_most.value_or(planned_.passes);
    planned_.at_least = at_least.value_or(std::min(2, planned_.at_most));
    if (until && planned_.at_least > planned_.at_most)
      draft_.fault(repeat.find(at_least ? "at_least" : "at_most")->origin,
                   what_ + ": at least " + std::to_string(planned_.at_least) +
                       " passes, but at most " + std::to_string(planned_.at_most) + ".");
    if (at_most && *at_most < planned_.passes)
      draft_.fault(repeat.find("at_most")->value.origin,
                   what_ + ": the rows have " + std::to_string(planned_.passes) +
                       " columns, but 'at_most' is " + std::to_string(*at_most) +
                       ": the last are never reached.",
                   "Shorten the rows.");
    if (planned_.rows.empty() && !at_most)
      draft_.fault(planned_.origin, what_ + ": nothing says how many passes.",
                   "Write rows under 'passes', or 'at_most'.");
  }

  void read_exhausted(const Node& repeat) {
    if (const Node* node = repeat.at("if_exhausted")) {
      ParameterDescription type;
      type.kind = ParameterKind::choice;
      type.choices = {{"warn", ""}, {"fail", ""}, {"accept", ""}};
      const auto value = value_of(draft_, what_ + ": 'if_exhausted'", type, *node, -1, nullptr);
      const std::string text = value && std::holds_alternative<std::string>(*value)
                                   ? std::get<std::string>(*value)
                                   : "warn";
      planned_.if_exhausted = text == "fail"     ? Exhausted::fail
                              : text == "accept" ? Exhausted::accept
                                                 : Exhausted::warn;
    }
  }

  Draft& draft_;
  int index_;
  PlannedRepeat& planned_;
  std::string what_;
};

}  // namespace

void read_passes(Draft& draft, int repeat) { Passes(draft, repeat).read(); }

}  // namespace plumb::pipeline
