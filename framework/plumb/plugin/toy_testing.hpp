#pragma once
/// For tests of steps that know no SLAM: the step bases and the views of inputs that go with the
/// types of data/toy_testing.hpp, as a module would define them.

#include "plumb/data/toy_testing.hpp"
#include "plumb/plugin/declaration.hpp"

namespace plumb::toy {

using FrameStep = ItemStep<&frame_kind>;
using SegmentStep = ItemStep<&segment_kind>;
using EdgeStep = ItemStep<&edge_kind>;

/// In an EdgeStep: of Poses only how far j is from i.
struct Relative {
  double shift = 0;
  bool wired = false;
};
/// In an EdgeStep: which edges there are; the content is not seen and not in the key.
struct OverEdges {
  bool wired = false;
};
/// In an EdgeStep: the edge itself.
struct ThisEdge {
  Edge edge;
  bool wired = false;
};

}  // namespace plumb::toy

namespace plumb {

template <>
struct InputTraits<toy::Relative> : PartOf<toy::Poses> {
  static constexpr const char* sees = "only the shift of the edge";
  static SeenPart part(const toy::Poses& poses, const ItemPlace& edge) {
    return seen_part(poses.places[edge.j] - poses.places[edge.i]);
  }
  static std::size_t ends_count(const toy::Poses& poses) { return poses.places.size(); }
  static void set(toy::Relative& to, const PortInput& from) {
    to = {*from.part.as<double>(), from.wired};
  }
};

template <>
struct InputTraits<toy::OverEdges> : PartOf<toy::Edges> {
  static constexpr const char* sees = "says which edges there are";
  static SeenPart part(const toy::Edges&, const ItemPlace&) { return {}; }
  static void set(toy::OverEdges& to, const PortInput& from) { to = {from.wired}; }
};

template <>
struct InputTraits<toy::ThisEdge> : PartOf<toy::Edges> {
  static constexpr const char* sees = "only the edge itself";
  static SeenPart part(const toy::Edges& edges, const ItemPlace& edge) {
    return seen_part(edges.list[edge.k]);
  }
  static void set(toy::ThisEdge& to, const PortInput& from) {
    to = {*from.part.as<toy::Edge>(), from.wired};
  }
};

}  // namespace plumb
