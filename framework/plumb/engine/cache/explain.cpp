#include "plumb/engine/cache/explain.hpp"

#include <algorithm>

namespace plumb {

std::string first_difference(const Facts& before, const Facts& now) {
  const auto in = [](const Facts& facts, const std::string& name) {
    return std::find_if(facts.begin(), facts.end(),
                        [&](const auto& fact) { return fact.name == name; });
  };
  for (const auto& [name, value] : now) {
    const auto at = in(before, name);
    if (at == before.end()) return name + " is new: " + value;
    if (at->value != value) return name + " was " + at->value + ", is " + value;
  }
  for (const auto& [name, value] : before)
    if (in(now, name) == now.end()) return name + " is gone, was " + value;
  return "";
}

std::string Explained::text() const {
  const std::string name = path + (pass < 0 ? "" : ", pass " + std::to_string(pass + 1)) + ": ";
  const std::string because = why.empty() ? "" : ": " + why;
  if (passes) return name + "passes through" + because;
  const std::string all = " of " + std::to_string(made + reused);
  if (made + reused == 0) return name + "has no items" + because;
  if (made == 0)
    return name + "reused" + (reused == 1 ? "" : ", all " + std::to_string(reused)) + because;
  return name +
         (reused == 0 ? "made" + (made == 1 ? std::string() : ", all " + std::to_string(made))
                      : std::to_string(made) + all + " made") +
         because;
}

}  // namespace plumb
