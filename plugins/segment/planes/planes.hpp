#pragma once
/// The planes of a segment: a value of its own.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "plumb/slam/types.hpp"

namespace plumb::segment_planes {

/// A plane in segment coordinates: normal . p = offset.
struct Plane {
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  float offset = 0;                                    ///< [m]
  Eigen::Vector3f centroid = Eigen::Vector3f::Zero();  ///< of its points [m]
  float rms = 0;                                       ///< of their distances from it [m]
  std::uint32_t points = 0;
};

/// The planes of a segment, those with the most points first, and on which of them each of its
/// points lies.
struct Planes {
  std::vector<Plane> planes;
  std::vector<std::uint32_t> label;  ///< of each point: 1 + the place of its plane; 0: on none
};

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Plane>
void fields(Archive& a, T& plane) {
  a(plane.normal, plane.offset, plane.centroid, plane.rms, plane.points);
}
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Planes>
void fields(Archive& a, T& planes) { a(planes.planes, planes.label); }

}  // namespace plumb::segment_planes

template <>
struct plumb::TypeTraits<plumb::segment_planes::Planes> {
  static constexpr const char* name = "Planes";
  static constexpr int version = 1;
  static const ItemKind& kind() { return segment_kind(); }
  static std::string layout() { return eigen_layout(); }
  static const char* fault(const segment_planes::Planes& value) {
    for (const auto& plane : value.planes)
      if (!plane.normal.allFinite() || !plane.centroid.allFinite() ||
          !std::isfinite(plane.offset) || !std::isfinite(plane.rms))
        return "a plane with a non-finite number";
    const bool named = std::ranges::all_of(
        value.label, [&](std::uint32_t label) { return label <= value.planes.size(); });
    return named ? "" : "a point on a plane that there is not";
  }
};
