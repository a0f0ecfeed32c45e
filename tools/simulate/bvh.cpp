#include "simulate/bvh.hpp"

#include <algorithm>
#include <array>

namespace plumb::simulate {
namespace {

constexpr int bins = 16;
constexpr std::uint32_t leaf_size = 2;

float area(const Box& box) {
  if (box.empty()) return 0;
  const Eigen::Vector3f s = box.high - box.low;
  return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
}

void grow(Box& box, const Box& other) {
  box.low = box.low.cwiseMin(other.low);
  box.high = box.high.cwiseMax(other.high);
}

struct Cut {
  int axis = -1;
  int bin = 0;
  float cost = std::numeric_limits<float>::infinity();
};

/// The cheapest of the planes between bins: area times number on either side (surface area
/// heuristic).
Cut best_cut(const Primitive* first, std::uint32_t count, const Box& centres) {
  Cut best;
  for (int axis = 0; axis < 3; ++axis) {
    const float low = centres.low[axis], extent = centres.high[axis] - low;
    if (!(extent > 0)) continue;
    std::array<Box, bins> box;
    std::array<float, bins> number{};
    for (std::uint32_t k = 0; k < count; ++k) {
      const int b =
          std::min(bins - 1, static_cast<int>((first[k].centre[axis] - low) / extent * bins));
      grow(box[static_cast<std::size_t>(b)], bounds(first[k]));
      number[static_cast<std::size_t>(b)] += 1;
    }
    std::array<float, bins> right{};
    Box sum;
    float n = 0;
    for (std::size_t b = bins - 1; b > 0; --b) {
      grow(sum, box[b]);
      n += number[b];
      right[b] = area(sum) * n;
    }
    sum = Box();
    n = 0;
    for (std::size_t b = 0; b + 1 < bins; ++b) {
      grow(sum, box[b]);
      n += number[b];
      const float cost = area(sum) * n + right[b + 1];
      if (n > 0 && n < static_cast<float>(count) && cost < best.cost)
        best = {axis, static_cast<int>(b), cost};
    }
  }
  return best;
}

}  // namespace

Bvh::Bvh(std::vector<Primitive>& primitives) {
  if (primitives.empty()) return;
  nodes_.reserve(2 * primitives.size());
  nodes_.push_back({Eigen::Vector3f::Zero(), 0, Eigen::Vector3f::Zero(),
                    static_cast<std::uint32_t>(primitives.size())});
  for (std::uint32_t k = 0; k < nodes_.size(); ++k) split(k, primitives);
}

void Bvh::split(std::uint32_t index, std::vector<Primitive>& primitives) {
  Node& node = nodes_[index];  // stays valid: capacity is reserved
  Primitive* first = primitives.data() + node.first;
  Box box, centres;
  for (std::uint32_t k = 0; k < node.count; ++k) {
    grow(box, bounds(first[k]));
    centres.add(first[k].centre);
  }
  node.low = box.low.array() - 1e-3f;  // more than the rounding of a slab test
  node.high = box.high.array() + 1e-3f;
  if (node.count <= leaf_size) return;
  const Cut cut = best_cut(first, node.count, centres);
  if (cut.axis < 0) return;
  const float low = centres.low[cut.axis], extent = centres.high[cut.axis] - low;
  const auto middle = std::stable_partition(first, first + node.count, [&](const Primitive& p) {
    return std::min(bins - 1, static_cast<int>((p.centre[cut.axis] - low) / extent * bins)) <=
           cut.bin;
  });
  const auto left = static_cast<std::uint32_t>(middle - first);
  const std::uint32_t begin = node.first, count = node.count;
  node.first = static_cast<std::uint32_t>(nodes_.size());
  node.count = 0;
  nodes_.push_back({Eigen::Vector3f::Zero(), begin, Eigen::Vector3f::Zero(), left});
  nodes_.push_back({Eigen::Vector3f::Zero(), begin + left, Eigen::Vector3f::Zero(), count - left});
}

}  // namespace plumb::simulate
