#pragma once
/// A tree of boxes over the world's solids, so that a ray looks at a few of them only.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "simulate/lanes.hpp"
#include "simulate/primitive.hpp"

namespace plumb::simulate {

/// Eight rays from one point: the nearer their directions, the less it costs.
struct Fan {
  Eigen::Vector3f origin;
  std::array<Eigen::Vector3f, lane_count> directions;
  Ray ray(std::size_t lane) const { return {origin, directions[lane]}; }
};
using Hits = std::array<Hit, lane_count>;

/// Built once, then read by any number of threads. The primitives are reordered so that those of a
/// leaf lie together.
class Bvh {
 public:
  Bvh() = default;
  explicit Bvh(std::vector<Primitive>& primitives);

  /// Calls visit(k, lane) for primitives k that the ray in `lane` may meet nearer than
  /// `hits[lane].t`, near boxes first; visit may lower that t.
  template <class Visit>
  void along(const Fan& fan, const Hits& hits, Visit visit) const;

 private:
  struct Node {
    Eigen::Vector3f low;
    std::uint32_t
        first;  ///< leaf: its first primitive; inner: its left child, the right one follows
    Eigen::Vector3f high;
    std::uint32_t count;  ///< 0: inner
  };
  /// What the slab test wants to know of the rays: 1 / direction, and origin / direction.
  struct Slabs {
    std::array<Lanes, 3> inverse, offset;
    explicit Slabs(const Fan& fan);
    /// Distance to the node's box; infinite where the ray passes by or meets something nearer.
    void enter(const Node& node, const Lanes& nearest, Lanes& distance) const;
  };
  void split(std::uint32_t node, std::vector<Primitive>& primitives);

  std::vector<Node> nodes_;
};

inline Bvh::Slabs::Slabs(const Fan& fan) {
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const float d = fan.directions[lane][static_cast<int>(k)];
      const float one_over = 1 / (std::abs(d) < 1e-20f ? 1e-20f : d);  // never 0 times infinity
      inverse[k][lane] = one_over;
      offset[k][lane] = fan.origin[static_cast<int>(k)] * one_over;
    }
}

inline void Bvh::Slabs::enter(const Node& node, const Lanes& nearest, Lanes& distance) const {
  Lanes in = {}, out = nearest;
  for (std::size_t k = 0; k < 3; ++k) {
    const Lanes a = node.low[static_cast<int>(k)] * inverse[k] - offset[k];
    const Lanes b = node.high[static_cast<int>(k)] * inverse[k] - offset[k];
    greater(in, a < b ? a : b);
    smaller(out, a < b ? b : a);
  }
  const Lanes never = in * 0 + std::numeric_limits<float>::infinity();
  distance = in <= out ? in : never;
}

template <class Visit>
void Bvh::along(const Fan& fan, const Hits& hits, Visit visit) const {
  if (nodes_.empty()) return;
  const Slabs slabs(fan);
  Lanes nearest;
  float farthest = 0;  // of the nearest hits
  const auto look = [&] {
    farthest = 0;
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      nearest[lane] = hits[lane].t;
      farthest = std::max(farthest, hits[lane].t);
    }
  };
  look();
  struct Waiting {
    std::uint32_t node;
    float enter;
  };
  std::array<Waiting, 96> stack;
  std::size_t top = 0;
  stack[top++] = {0, 0};
  Lanes left, right;
  while (top > 0) {
    const Waiting now = stack[--top];
    if (!(now.enter < farthest)) continue;
    const Node& node = nodes_[now.node];
    if (node.count > 0) {
      slabs.enter(node, nearest, left);
      for (std::size_t lane = 0; lane < lane_count; ++lane)
        if (left[lane] < nearest[lane])
          for (std::uint32_t k = 0; k < node.count; ++k) visit(node.first + k, lane);
      look();
      continue;
    }
    slabs.enter(nodes_[node.first], nearest, left);
    slabs.enter(nodes_[node.first + 1], nearest, right);
    const Waiting a{node.first, least(left)}, b{node.first + 1, least(right)};
    const bool left_first = a.enter <= b.enter;
    for (const Waiting& next : {left_first ? b : a, left_first ? a : b})
      if (next.enter < farthest) stack[top++] = next;
  }
}

}  // namespace plumb::simulate
