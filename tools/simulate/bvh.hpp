#pragma once
/// A tree of boxes over the world's solids, so that a ray looks at a few of them only.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "simulate/primitive.hpp"

namespace plumb::simulate {

/// Built once, then read by any number of threads. The primitives are reordered so that those of a
/// leaf lie together.
class Bvh {
 public:
  Bvh() = default;
  explicit Bvh(std::vector<Primitive>& primitives);

  /// Calls visit(k) for primitives that `ray` may meet nearer than `hit.t`, near boxes first; visit
  /// may lower hit.t.
  template <class Visit>
  void along(const Ray& ray, const Hit& hit, Visit visit) const;

 private:
  struct Node {
    Eigen::Vector3f low;
    std::uint32_t
        first;  ///< leaf: its first primitive; inner: its left child, the right one follows
    Eigen::Vector3f high;
    std::uint32_t count;  ///< 0: inner
  };
  void split(std::uint32_t node, std::vector<Primitive>& primitives);

  std::vector<Node> nodes_;
};

template <class Visit>
void Bvh::along(const Ray& ray, const Hit& hit, Visit visit) const {
  if (nodes_.empty()) return;
  Eigen::Vector3f inverse;  // a direction of 0 becomes a tiny one: no 0 times infinity
  for (int k = 0; k < 3; ++k)
    inverse[k] = 1 / (std::abs(ray.direction[k]) < 1e-20f ? 1e-20f : ray.direction[k]);
  const Eigen::Vector3f offset = ray.origin.cwiseProduct(inverse);
  const auto entry =
      [&](const Node& node) {  // distance to the box, infinite where the ray passes by
        float enter = 0, leave = hit.t;
        for (int k = 0; k < 3; ++k) {
          const float a = node.low[k] * inverse[k] - offset[k];
          const float b = node.high[k] * inverse[k] - offset[k];
          enter = std::max(enter, std::min(a, b));
          leave = std::min(leave, std::max(a, b));
        }
        return enter <= leave ? enter : std::numeric_limits<float>::infinity();
      };
  struct Waiting {
    std::uint32_t node;
    float enter;
  };
  Waiting stack[64];
  int top = 0;
  stack[top++] = {0, entry(nodes_[0])};
  while (top > 0) {
    const Waiting now = stack[--top];
    if (!(now.enter < hit.t)) continue;
    const Node& node = nodes_[now.node];
    if (node.count > 0) {
      for (std::uint32_t k = 0; k < node.count; ++k) visit(node.first + k);
      continue;
    }
    const float left = entry(nodes_[node.first]), right = entry(nodes_[node.first + 1]);
    if (left <= right) {
      stack[top++] = {node.first + 1, right};
      stack[top++] = {node.first, left};
    } else {
      stack[top++] = {node.first, left};
      stack[top++] = {node.first + 1, right};
    }
  }
}

}  // namespace plumb::simulate
