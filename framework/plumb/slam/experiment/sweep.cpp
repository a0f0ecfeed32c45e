#include <algorithm>

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "plumb/slam/experiment/experiment.hpp"

namespace plumb::experiment {

using pipeline::Node;

namespace {

constexpr std::size_t most_variants = 1000;

/// As written, without blanks: "0.2m", "[3m,1m]".
std::string shown(const Node& value) {
  if (value.is_list()) {
    std::string all;
    for (const Node& item : value.items) all += (all.empty() ? "" : ",") + shown(item);
    return "[" + all + "]";
  }
  std::string text = value.text;
  std::erase(text, ' ');
  return text;
}

/// A map with one key.
Node map_of(const std::string& key, const Origin& origin, Node value) {
  Node map;
  map.kind = Node::Kind::map;
  map.origin = origin;
  map.put(key, origin, std::move(value));
  return map;
}

/// What a variant of the sweep sets: of some axes, one value each.
using Point = std::vector<std::pair<const Axis*, const Node*>>;

Variant variant_at(const Point& point) {
  Variant variant;
  for (const auto& [axis, value] : point) {
    variant.name += (variant.name.empty() ? "" : ",") + axis->name + "=" + shown(*value);
    variant.edits.push_back(
        {map_of("set", axis->origin, map_of(axis->name, axis->origin, *value)), axis->text});
    variant.swept.emplace_back(axis->name, shown(*value));
  }
  std::ranges::replace(variant.name, '/', '_');  // of a path: the name is one of a folder
  return variant;
}

std::vector<Point> grid_of(const std::vector<Axis>& axes) {
  std::vector<Point> points(1);
  for (const Axis& axis : axes) {
    std::vector<Point> next;
    for (const Point& point : points)
      for (const Node& value : axis.values) {
        if (next.size() > most_variants) return next;  // too many, which is told
        next.push_back(point);
        next.back().emplace_back(&axis, &value);
      }
    points = std::move(next);
  }
  return points;
}

std::vector<Point> pairs_of(const std::vector<Axis>& axes) {
  for (const Axis& axis : axes)
    if (axis.values.size() != axes.front().values.size())
      throw Error("paired sweep: '" + axes.front().name + "' has " +
                  counted(axes.front().values.size(), "values") + " and '" + axis.name + "' " +
                  std::to_string(axis.values.size()) + "; give both as many");
  std::vector<Point> points(axes.front().values.size());
  for (const Axis& axis : axes)
    for (std::size_t k = 0; k < points.size(); ++k) points[k].emplace_back(&axis, &axis.values[k]);
  return points;
}

std::vector<Point> singles_of(const std::vector<Axis>& axes) {
  std::vector<Point> points;
  for (const Axis& axis : axes)
    for (const Node& value : axis.values) points.push_back(Point{{&axis, &value}});
  return points;
}

/// The parts of a text at the commas that stand in no brackets.
std::vector<std::string> outer_parts(const std::string& text) {
  std::vector<std::string> parts(1);
  int depth = 0;
  for (const char c : text) {
    depth += (c == '[') - (c == ']');
    if (c == ',' && depth == 0)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

Node value_of_option(const std::string& text, const Origin& origin) {
  Node value;
  value.origin = origin;
  if (text.size() < 2 || text.front() != '[' || text.back() != ']') {
    value.kind = Node::Kind::scalar;
    value.text = text;
    return value;
  }
  value.kind = Node::Kind::list;
  for (const std::string& part : outer_parts(text.substr(1, text.size() - 2))) {
    Node item;
    item.kind = Node::Kind::scalar;
    item.origin = origin;
    item.text = part;
    value.items.push_back(std::move(item));
  }
  return value;
}

}  // namespace

std::vector<Variant> swept_variants(const std::vector<Axis>& axes, SweepBy by) {
  if (axes.empty()) return {};
  const auto points = by == SweepBy::grid     ? grid_of(axes)
                      : by == SweepBy::paired ? pairs_of(axes)
                                              : singles_of(axes);
  if (points.size() > most_variants)
    throw Error("the sweep makes more than " + std::to_string(most_variants) +
                " variants; give fewer values, or sweep one axis at a time");
  std::vector<Variant> variants;
  for (const Point& point : points) variants.push_back(variant_at(point));
  return variants;
}

Axis axis_of(const std::string& option) {
  const std::string place = "--sweep " + option;
  const auto equals = option.find('=');
  Axis axis{option.substr(0, equals), {place, 0, 0}, {}};
  if (equals == std::string::npos || equals == 0)
    throw Error(place + ": expected NAME=VALUE,VALUE, as in radius=0.2m,0.3m");
  for (const std::string& part : outer_parts(option.substr(equals + 1))) {
    if (part.empty()) throw Error(place + ": a value is missing; leave out the comma, or give one");
    axis.values.push_back(value_of_option(part, axis.origin));
  }
  return axis;
}

}  // namespace plumb::experiment
