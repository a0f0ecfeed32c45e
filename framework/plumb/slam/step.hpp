#pragma once
/// The step bases and the views of inputs that go with frames, segments and edges.

#include "plumb/plugin/declaration.hpp"
#include "plumb/slam/types.hpp"

namespace plumb {

/// One call sees one frame, one segment, one edge.
using FrameStep = ItemStep<&frame_kind>;
using SegmentStep = ItemStep<&segment_kind>;
using EdgeStep = ItemStep<&edge_kind>;

/// In an EdgeStep: of Poses only T_i_j of the edge.
struct Relative {
  Pose T_i_j;
  bool wired = false;
  explicit operator bool() const { return wired; }
};
/// In an EdgeStep: which edges there are; the content is not seen and not in the key.
struct OverEdges {
  bool wired = false;
};
/// In an EdgeStep: the edge itself.
struct ThisEdge {
  Edge edge;
  bool wired = false;
  explicit operator bool() const { return wired; }
};

template <>
struct InputTraits<Relative> : PartOf<Poses> {
  static constexpr const char* sees = "only T_i_j of the edge";
  static SeenPart part(const Poses& poses, const ItemPlace& edge) {
    return seen_part(poses.relative(edge.i, edge.j));
  }
  static std::size_t ends_count(const Poses& poses) { return poses.size(); }
  static void set(Relative& to, const PortInput& from) { to = {*from.part.as<Pose>(), from.wired}; }
};
template <>
struct InputTraits<OverEdges> : PartOf<Edges> {
  static constexpr const char* sees = "says which edges there are";
  static SeenPart part(const Edges&, const ItemPlace&) { return {}; }
  static void set(OverEdges& to, const PortInput& from) { to = {from.wired}; }
};
template <>
struct InputTraits<ThisEdge> : PartOf<Edges> {
  static constexpr const char* sees = "only the edge itself";
  static SeenPart part(const Edges& edges, const ItemPlace& edge) {
    return seen_part(edges.list[edge.k]);
  }
  static void set(ThisEdge& to, const PortInput& from) { to = {*from.part.as<Edge>(), from.wired}; }
};

/// The edges that edge-wise values belong to: value k is that of list[k].
template <class T>
const Edges& edges_of(const Each<T>& each) {
  return *each.list().template as<Edges>();
}

}  // namespace plumb
