#pragma once
/// For tests of what knows no SLAM: item kinds and value types as a module would define them, with
/// the names of the real ones, their relations and some of their faults.

#include <cmath>

#include "plumb/data/toy_values_testing.hpp"
#include "plumb/data/type.hpp"

namespace plumb::toy {

inline const ItemKind& frame_kind() {
  static const ItemKind kind = {.name = "frame", .transient = true};
  return kind;
}
inline const ItemKind& segment_kind() {
  static const ItemKind kind = {.name = "segment", .parts = "frame", .ranges = "FrameRange"};
  return kind;
}
inline const ItemKind& edge_kind() {
  static const ItemKind kind = {.name = "edge", .ends = "segment", .list = "Edges"};
  return kind;
}

/// What the traits of a type have that has one value for each item of a kind.
template <const ItemKind& (*Kind)()>
struct OneEach {
  static constexpr int version = 1;
  static const ItemKind& kind() { return Kind(); }
};

}  // namespace plumb::toy

namespace plumb {

template <>
struct TypeTraits<toy::Frame> : toy::OneEach<&toy::frame_kind> {
  static constexpr const char* name = "Frame";
};

template <>
struct TypeTraits<toy::FrameRange> : toy::OneEach<&toy::segment_kind> {
  static constexpr const char* name = "FrameRange";
  static std::pair<std::size_t, std::size_t> range(const toy::FrameRange& r) {
    return {r.first, r.end};
  }
};

template <>
struct TypeTraits<toy::Segment> : toy::OneEach<&toy::segment_kind> {
  static constexpr const char* name = "Segment";
  static constexpr bool large = true;
  static const char* fault(const toy::Segment& segment) {
    if (segment.frame.size() != segment.points.size())
      return "a segment that does not name a frame for each point";
    for (const auto frame : segment.frame)
      if (frame >= segment.range.size()) return "a point of a frame that its segment does not have";
    return "";
  }
};

template <>
struct TypeTraits<toy::Features> : toy::OneEach<&toy::segment_kind> {
  static constexpr const char* name = "Features";
};

template <>
struct TypeTraits<toy::Edges> {
  static constexpr const char* name = "Edges";
  static constexpr int version = 1;
  static std::size_t size(const toy::Edges& edges) { return edges.list.size(); }
  static std::pair<std::size_t, std::size_t> ends(const toy::Edges& edges, std::size_t k) {
    return {edges.list[k].i, edges.list[k].j};
  }
  static std::size_t ends_count(const toy::Edges& edges) { return edges.segments; }
  static const char* fault(const toy::Edges& edges) {
    const toy::Edge* last = nullptr;
    for (const toy::Edge& edge : edges.list) {
      if (edge.i >= edge.j || edge.j >= edges.segments)
        return "an edge between segments that there are not, or of a segment with itself";
      if (last && std::pair(last->i, last->j) >= std::pair(edge.i, edge.j))
        return "edges that are not in order, each pair once";
      last = &edge;
    }
    return "";
  }
};

template <>
struct TypeTraits<toy::Matches> : toy::OneEach<&toy::edge_kind> {
  static constexpr const char* name = "Matches";
  static toy::Matches empty() { return {}; }
  static const char* fault(const toy::Matches& matches) {
    const std::size_t n = matches.p.size();
    const bool alike =
        matches.q.size() == n && (matches.weight.empty() || matches.weight.size() == n);
    return alike ? "" : "matches whose columns are not equally long";
  }
};

template <>
struct TypeTraits<toy::Registration> : toy::OneEach<&toy::edge_kind> {
  static constexpr const char* name = "Registration";
};

template <>
struct TypeTraits<toy::Poses> {
  static constexpr const char* name = "Poses";
  static constexpr int version = 1;
  static const char* fault(const toy::Poses& poses) {
    for (const double place : poses.places)
      if (!std::isfinite(place)) return "a pose with a non-finite number";
    return "";
  }
};

template <>
struct TypeTraits<toy::Trajectory> {
  static constexpr const char* name = "Trajectory";
  static constexpr int version = 1;
};

template <>
struct TypeTraits<toy::Metrics> {
  static constexpr const char* name = "Metrics";
  static constexpr int version = 1;
  static const std::vector<Number>& numbers(const toy::Metrics& metrics) { return metrics.numbers; }
};

}  // namespace plumb
