/// What a repeat says of its passes: rows, carried values, how many.
#include <algorithm>

#include "plumb/pipeline/bind/declaring.hpp"
#include "plumb/pipeline/bind/values.hpp"

namespace plumb::pipeline {
namespace {

class PassesReader {
 public:
  PassesReader(Outline& outline, int index, const Settings& settings, Reading& reading)
      : outline_(outline),
        repeat_(outline.repeats[index]),
        settings_(settings),
        reading_(reading),
        what_("repeat '" + repeat_.path + "'") {}

  Passes read() {
    const Node& node = *repeat_.node;
    check_keys(reading_.diagnostics, node, what_, {"repeat", "start", "steps"});
    const Node& repeat = *node.at("repeat");
    if (!check_keys(reading_.diagnostics, repeat, what_,
                    {"passes", "carry", "until", "at_least", "at_most", "if_exhausted"}))
      return {};
    read_rows(repeat);
    read_carries(repeat, node.at("start"));
    read_counts(repeat);
    read_exhausted(repeat);
    if (counted_) passes_.counts = counts_;
    return std::move(passes_);
  }

 private:
  void read_rows(const Node& repeat) {
    const Node* passes = repeat.at("passes");
    if (!passes) return;
    if (!passes->is_map())
      return reading_.fault(passes->origin,
                            what_ + ": 'passes' is a map of rows, found " + passes->shown() + ".");
    std::string longest;
    for (const Entry& entry : passes->entries) {
      DeclaredRow row{entry.key, {}, entry.value.origin};
      if (entry.value.is_list())
        for (const Node& item : entry.value.items) row.values.push_back(&item);
      else
        row.values.push_back(&entry.value);
      const int columns = static_cast<int>(row.values.size());
      const std::string name = what_ + ": the row '" + entry.key + "'";
      if (!valid_name(entry.key))
        reading_.fault(entry.origin,
                       name + " has no valid name: letters, digits and '_', a letter first.");
      if (columns == 0) reading_.fault(entry.origin, name + " is empty.");
      refuse_shadow(entry, name);
      if (columns > 1 && counts_.columns > 1 && columns != counts_.columns)
        reading_.fault(entry.value.origin,
                       name + " has " + std::to_string(columns) + " values, '" + longest +
                           "' has " + std::to_string(counts_.columns) + ".",
                       "Rows are equally long, or one value for all passes.");
      else if (columns > 1)
        counts_.columns = columns, longest = entry.key;
      passes_.rows.push_back(std::move(row));
    }
  }

  void refuse_shadow(const Entry& row, const std::string& name) {
    const auto setting = settings_.find(row.key);
    if (setting != settings_.end())
      reading_.fault(row.origin, name + " has the name of a parameter of the pipeline.",
                     "That is at " + setting->second.declared.text() + ".");
    for (int outer = repeat_.parent; outer >= 0; outer = outline_.repeats[outer].parent)
      for (const DeclaredRow& other : outline_.repeats[outer].passes.rows)
        if (other.name == row.key)
          reading_.fault(row.origin, name + " has the name of an outer row.",
                         "That is at " + other.origin.text() + ".");
  }

  void read_carries(const Node& repeat, const Node* start) {
    const Node* carry = repeat.at("carry");
    if (carry && !carry->is_map())
      return reading_.fault(carry->origin,
                            what_ + ": 'carry' is a map, found " + carry->shown() + ".");
    if (start && !start->is_map())
      return reading_.fault(start->origin,
                            what_ + ": 'start' is a map, found " + start->shown() + ".");
    if (start)
      for (const Entry& entry : start->entries)
        if (!carry || !carry->find(entry.key))
          reading_.fault(
              entry.origin, what_ + ": 'start' names '" + entry.key + "', which is not carried.",
              did_you_mean(entry.key, carry ? carry->keys() : std::vector<std::string>()));
    if (!carry) return;
    for (const Entry& entry : carry->entries) {
      const Symbol symbol{Symbol::Kind::carry, static_cast<int>(passes_.carries.size()),
                          entry.origin};
      if (!add_name(outline_.scopes, repeat_.body, entry.key, symbol, reading_.diagnostics))
        continue;
      DeclaredCarry carried{entry.key, Faulty(), &entry.value};
      if (const Node* before = start ? start->at(entry.key) : nullptr)
        carried.start = before;
      else
        reading_.fault(
            entry.origin,
            what_ + ": '" + entry.key +
                "' is carried, but 'start' does not say what it is before the first pass.");
      passes_.carries.push_back(std::move(carried));
    }
  }

  /// Of what says how many passes: then the counts are faulty.
  void miscounted(const Origin& origin, const std::string& sentence, const std::string& hint = "") {
    reading_.fault(origin, what_ + sentence, hint);
    counted_ = false;
  }

  std::optional<int> count(const Node& repeat, const char* key) {
    const Node* node = repeat.at(key);
    if (!node) return std::nullopt;
    ParameterDescription type;
    type.name = key;
    type.kind = ParameterKind::integer;
    type.low = 1;
    type.high = 1000;
    const auto value = value_of(reading_, settings_, what_ + ": '" + key + "'", type, *node);
    counted_ = counted_ && value;
    if (!value || !std::holds_alternative<std::int64_t>(value->value)) return std::nullopt;
    return static_cast<int>(std::get<std::int64_t>(value->value));
  }

  void read_counts(const Node& repeat) {
    const Node* until = repeat.at("until");
    for (const char* key : {"at_least", "if_exhausted"})
      if (!until && repeat.at(key))
        miscounted(repeat.find(key)->origin,
                   ": '" + std::string(key) + "' means nothing without 'until'.");
    const auto at_least = count(repeat, "at_least"), at_most = count(repeat, "at_most");
    counts_.at_most = at_most.value_or(counts_.columns);
    counts_.at_least = at_least.value_or(std::min(2, counts_.at_most));
    if (until && counts_.at_least > counts_.at_most)
      miscounted(repeat.find(at_least ? "at_least" : "at_most")->origin,
                 ": at least " + std::to_string(counts_.at_least) + " passes, but at most " +
                     std::to_string(counts_.at_most) + ".");
    if (at_most && *at_most < counts_.columns)
      miscounted(repeat.find("at_most")->value.origin,
                 ": the rows have " + std::to_string(counts_.columns) +
                     " columns, but 'at_most' is " + std::to_string(*at_most) +
                     ": the last are never reached.",
                 "Shorten the rows.");
    if (passes_.rows.empty() && !at_most)
      miscounted(repeat_.origin, ": nothing says how many passes.",
                 "Write rows under 'passes', or 'at_most'.");
  }

  void read_exhausted(const Node& repeat) {
    const Node* node = repeat.at("if_exhausted");
    if (!node) return;
    ParameterDescription type;
    type.kind = ParameterKind::choice;
    type.choices = {{"warn", ""}, {"fail", ""}, {"accept", ""}};
    const auto value = value_of(reading_, settings_, what_ + ": 'if_exhausted'", type, *node);
    counted_ = counted_ && value;
    const std::string text = value && std::holds_alternative<std::string>(value->value)
                                 ? std::get<std::string>(value->value)
                                 : "warn";
    counts_.if_exhausted = text == "fail"     ? Exhausted::fail
                           : text == "accept" ? Exhausted::accept
                                              : Exhausted::warn;
  }

  Outline& outline_;
  const DeclaredRepeat& repeat_;
  const Settings& settings_;
  Reading& reading_;
  std::string what_;
  Passes passes_;
  Counts counts_;
  bool counted_ = true;
};

}  // namespace

Passes passes_of(Outline& outline, int repeat, const Settings& settings, Reading& reading) {
  return PassesReader(outline, repeat, settings, reading).read();
}

}  // namespace plumb::pipeline
