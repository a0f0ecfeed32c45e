#pragma once
/// For tests of steps: a context that runs everything in this thread, and inputs made from plain
/// values.

#include <map>

#include "plumb/plugin/declaration.hpp"

namespace plumb {

/// Runs parallel bodies one after another and remembers what was said.
class TestContext : public Context {
 public:
  explicit TestContext(std::uint64_t seed = 1) : seed_(seed) {}
  void count(std::string_view what, std::uint64_t n) override { counts[std::string(what)] += n; }
  void warn(const std::string& sentence) override { warnings.push_back(sentence); }
  std::uint64_t seed() const override { return seed_; }
  void parallel(std::size_t n, const std::function<void(std::size_t)>& body) override {
    for (std::size_t k = 0; k < n; ++k) body(k);
  }
  std::map<std::string, std::uint64_t> counts;
  std::vector<std::string> warnings;

 private:
  std::uint64_t seed_;
};

/// A collection of values held in memory; `list` for those of listed items (edges).
template <class T>
std::shared_ptr<const Collection> held(std::vector<T> values, AnyValue list) {
  struct Held : Collection {
    std::vector<AnyValue> items;
    AnyValue of;
    std::size_t size() const override { return items.size(); }
    AnyValue open(std::size_t k) const override { return items[k]; }
    AnyValue list() const override { return of; }
  };
  auto all = std::make_shared<Held>();
  all->of = std::move(list);
  for (auto& value : values) all->items.push_back(any_value(std::move(value)));
  return all;
}
template <class T>
Each<T> each_of(std::vector<T> values) {
  return Each<T>(held(std::move(values), {}));
}
template <class T, class List>
Each<T> each_of(std::vector<T> values, List list) {
  return Each<T>(held(std::move(values), any_value(std::move(list))));
}

}  // namespace plumb
