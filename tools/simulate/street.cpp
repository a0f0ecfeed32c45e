#include "simulate/street.hpp"

#include <algorithm>
#include <cmath>

namespace plumb::simulate {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float cell = 16;        // of the maps' buckets [m]
constexpr float same_street = 5;  // passes nearer than that [m] ...
constexpr std::uint32_t later =
    30;  // ... and this far apart along the path [m] are two of one street

std::uint64_t key(std::int32_t i, std::int32_t j) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32 |
         static_cast<std::uint32_t>(j);
}
std::int32_t bucket(float v) { return static_cast<std::int32_t>(std::floor(v / cell)); }

/// Calls visit(index) for all entries in buckets that a square round `p` meets, until one returns
/// true.
template <class Cells, class Visit>
bool around(const Cells& cells, const Vector2f& p, float radius, Visit visit) {
  for (auto j = bucket(p.y() - radius); j <= bucket(p.y() + radius); ++j)
    for (auto i = bucket(p.x() - radius); i <= bucket(p.x() + radius); ++i)
      if (const auto found = cells.find(key(i, j)); found != cells.end())
        for (const std::uint32_t k : found->second)
          if (visit(k)) return true;
  return false;
}

/// Positions a metre apart along the line through `path`.
std::vector<Vector3f> every_metre(const std::vector<Vector3f>& path) {
  std::vector<Vector3f> result{path.front()};
  float left = 1;  // to the next position
  for (std::size_t k = 1; k < path.size(); ++k) {
    const Vector3f step = path[k] - path[k - 1];
    const float length = step.head<2>().norm();
    float gone = left;
    for (; gone <= length; gone += 1) result.push_back(path[k - 1] + gone / length * step);
    left = gone - length;
  }
  return result;
}

/// Whether two rectangles overlap by more than `tolerance` along each axis of `a`.
bool meet_along(const Footprint& a, const Footprint& b, float tolerance) {
  const Vector2f centre = a.local(b.centre).cwiseAbs();
  const float cosine = std::abs(a.along.dot(b.along));
  const float sine = std::abs(a.along.x() * b.along.y() - a.along.y() * b.along.x());
  const Vector2f reach(cosine * b.half.x() + sine * b.half.y(),
                       sine * b.half.x() + cosine * b.half.y());
  return ((a.half + reach - centre).array() > tolerance).all();
}

}  // namespace

Street::Street(const std::vector<Vector3f>& path) {
  const std::vector<Vector3f> points = every_metre(path);
  const std::size_t n = points.size();
  nodes_.reserve(n);
  Vector2f along(1, 0);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t before = k < 3 ? 0 : k - 3, after = std::min(n - 1, k + 3);
    const Vector2f way = points[after].head<2>() - points[before].head<2>();
    if (way.norm() > 0.1f) along = way.normalized();
    const Vector2f at = points[k].head<2>();
    const bool repeated = around(cells_, at, same_street, [&](std::uint32_t other) {
      return other + later < k && (nodes_[other].at - at).norm() < same_street;
    });
    nodes_.push_back({at, along, points[k].z(), repeated});
    cells_[key(bucket(at.x()), bucket(at.y()))].push_back(static_cast<std::uint32_t>(k));
  }
}

bool Street::clear(const Footprint& rectangle, float clearance) const {
  return !around(cells_, rectangle.centre, rectangle.half.norm() + clearance,
                 [&](std::uint32_t k) { return rectangle.distance(nodes_[k].at) < clearance; });
}

bool Plots::free(const Footprint& rectangle, float tolerance) const {
  return !around(cells_, rectangle.centre, rectangle.half.norm(), [&](std::uint32_t k) {
    return meet_along(rectangle, taken_[k], tolerance) &&
           meet_along(taken_[k], rectangle, tolerance);
  });
}

void Plots::take(const Footprint& rectangle) {
  const auto index = static_cast<std::uint32_t>(taken_.size());
  taken_.push_back(rectangle);
  const float reach = rectangle.half.norm();
  for (auto j = bucket(rectangle.centre.y() - reach); j <= bucket(rectangle.centre.y() + reach);
       ++j)
    for (auto i = bucket(rectangle.centre.x() - reach); i <= bucket(rectangle.centre.x() + reach);
         ++i)
      cells_[key(i, j)].push_back(index);
}

}  // namespace plumb::simulate
