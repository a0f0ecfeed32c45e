#pragma once
/// The item kinds and value types of SLAM as the framework knows them: registered like those of
/// any other module.

#include "plumb/data/type.hpp"
#include "plumb/slam/fault.hpp"
#include "plumb/slam/registration.hpp"

namespace plumb {

/// One scan of the sensor.
inline const ItemKind& frame_kind() {
  static const ItemKind kind = {.name = "frame", .transient = true};
  return kind;
}
/// Consecutive frames that are one rigid piece.
inline const ItemKind& segment_kind() {
  static const ItemKind kind = {.name = "segment", .parts = "frame", .ranges = "FrameRange"};
  return kind;
}
/// Two segments that should fit together.
inline const ItemKind& edge_kind() {
  static const ItemKind kind = {.name = "edge", .ends = "segment", .list = "Edges"};
  return kind;
}

/// Instruction set and definitions change how Eigen aligns a pose.
inline std::string eigen_layout() {
  return "Eigen " + std::to_string(EIGEN_WORLD_VERSION) + "." +
         std::to_string(EIGEN_MAJOR_VERSION) + ", pose " + std::to_string(sizeof(Pose)) + "/" +
         std::to_string(alignof(Pose));
}

namespace detail {

/// What all of them have.
template <class T>
struct SlamTraits {
  static const char* fault(const T& value) { return fault_in(value); }
  static std::string layout() { return eigen_layout(); }
};
template <class T>
struct FrameTraits : SlamTraits<T> {
  static const ItemKind& kind() { return frame_kind(); }
};
template <class T>
struct SegmentTraits : SlamTraits<T> {
  static const ItemKind& kind() { return segment_kind(); }
};
template <class T>
struct EdgeTraits : SlamTraits<T> {
  static const ItemKind& kind() { return edge_kind(); }
};

}  // namespace detail

template <>
struct TypeTraits<Trajectory> : detail::SlamTraits<Trajectory> {
  static constexpr const char* name = "Trajectory";
  static constexpr int version = 1;
};

template <>
struct TypeTraits<Frame> : detail::FrameTraits<Frame> {
  static constexpr const char* name = "Frame";
  static constexpr int version = 1;
};

template <>
struct TypeTraits<FrameRange> : detail::SegmentTraits<FrameRange> {
  static constexpr const char* name = "FrameRange";
  static constexpr int version = 1;
  static std::pair<std::size_t, std::size_t> range(const FrameRange& r) { return {r.first, r.end}; }
};

template <>
struct TypeTraits<Segment> : detail::SegmentTraits<Segment> {
  static constexpr const char* name = "Segment";
  static constexpr int version = 1;
  static constexpr bool large = true;
  /// Of a search tree: 12 bytes for the copy of a point, 12 for its place in the tree.
  static std::size_t extra_bytes(const Segment& segment) { return segment.cloud.size() * 24; }
};

template <>
struct TypeTraits<Descriptor> : detail::SegmentTraits<Descriptor> {
  static constexpr const char* name = "Descriptor";
  static constexpr int version = 1;
};

template <>
struct TypeTraits<Features> : detail::SegmentTraits<Features> {
  static constexpr const char* name = "Features";
  static constexpr int version = 1;
};

template <>
struct TypeTraits<Edges> : detail::SlamTraits<Edges> {
  static constexpr const char* name = "Edges";
  static constexpr int version = 1;
  static std::size_t size(const Edges& edges) { return edges.size(); }
  static std::pair<std::size_t, std::size_t> ends(const Edges& edges, std::size_t k) {
    return {edges.list[k].i, edges.list[k].j};
  }
  static std::size_t ends_count(const Edges& edges) { return edges.segments; }
};

template <>
struct TypeTraits<Matches> : detail::EdgeTraits<Matches> {
  static constexpr const char* name = "Matches";
  static constexpr int version = 1;
  static Matches empty() { return {}; }
};

template <>
struct TypeTraits<Registration> : detail::EdgeTraits<Registration> {
  static constexpr const char* name = "Registration";
  static constexpr int version = 1;
};

template <>
struct TypeTraits<Constraints> : detail::SlamTraits<Constraints> {
  static constexpr const char* name = "Constraints";
  static constexpr int version = 1;
};

template <>
struct TypeTraits<Poses> : detail::SlamTraits<Poses> {
  static constexpr const char* name = "Poses";
  static constexpr int version = 1;
};

template <>
struct TypeTraits<GridMap> : detail::SlamTraits<GridMap> {
  static constexpr const char* name = "GridMap";
  static constexpr int version = 1;
};

template <>
struct TypeTraits<Metrics> : detail::SlamTraits<Metrics> {
  static constexpr const char* name = "Metrics";
  static constexpr int version = 1;
  static const std::vector<Number>& numbers(const Metrics& metrics) { return metrics.numbers; }
};

// Their code is compiled once, in libplumb_slam, and not by everybody who includes this.
#define PLUMB_TYPE_IN_LIBRARY(T) \
  extern template __attribute__((visibility("default"))) const Type& type_of<T>();
PLUMB_TYPE_IN_LIBRARY(Trajectory)
PLUMB_TYPE_IN_LIBRARY(Frame)
PLUMB_TYPE_IN_LIBRARY(FrameRange)
PLUMB_TYPE_IN_LIBRARY(Segment)
PLUMB_TYPE_IN_LIBRARY(Descriptor)
PLUMB_TYPE_IN_LIBRARY(Features)
PLUMB_TYPE_IN_LIBRARY(Edges)
PLUMB_TYPE_IN_LIBRARY(Matches)
PLUMB_TYPE_IN_LIBRARY(Registration)
PLUMB_TYPE_IN_LIBRARY(Constraints)
PLUMB_TYPE_IN_LIBRARY(Poses)
PLUMB_TYPE_IN_LIBRARY(GridMap)
PLUMB_TYPE_IN_LIBRARY(Metrics)
#undef PLUMB_TYPE_IN_LIBRARY

}  // namespace plumb
