#include "shared/overlapping/neighbours.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"

namespace plumb::overlapping {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

std::vector<Pair> meeting(const std::vector<Eigen::AlignedBox3d>& boxes, double margin) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t k = 0; k < boxes.size(); ++k)
    if (!boxes[k].isEmpty()) order.push_back(k);
  std::ranges::sort(order, [&](auto a, auto b) {
    return std::pair(boxes[a].min().x(), a) < std::pair(boxes[b].min().x(), b);
  });
  std::vector<Pair> pairs;
  std::vector<std::uint32_t> open;  // boxes that may still reach the one at hand
  for (const auto k : order) {
    std::erase_if(open, [&](auto n) { return boxes[n].max().x() + margin < boxes[k].min().x(); });
    for (const auto n : open)
      if ((boxes[n].min().array() - margin <= boxes[k].max().array()).all() &&
          (boxes[k].min().array() - margin <= boxes[n].max().array()).all())
        pairs.emplace_back(std::min(n, k), std::max(n, k));
    open.push_back(k);
  }
  std::ranges::sort(pairs);
  return pairs;
}

Neighbourhood neighbours(std::size_t count, const Opener& segment, const Poses& poses,
                         const OverlapOptions& options, const Comparison& comparison,
                         Context& context) {
  std::vector<Eigen::AlignedBox3d> boxes(count);
  std::vector<Eigen::Vector3d> centroids(count);
  context.parallel(count, [&](std::size_t k) {
    const auto at_hand = segment(k);
    boxes[k] = world_box(at_hand->box, poses.T_world_segment[k]);
    centroids[k] = poses.T_world_segment[k] * at_hand->centroid.cast<double>().eval();
  });
  const Lattice lattice = lattice_over(boxes, options.resolution);
  context.parallel(count, [&](std::size_t k) {
    comparison.hold(k, segment(k)->cloud, poses.T_world_segment[k], lattice);
  });
  const auto edge = [&](std::uint32_t i, std::uint32_t j, EdgeKind kind, double score) {
    return Edge{i, j, kind, static_cast<float>(score),
                static_cast<float>((centroids[i] - centroids[j]).norm())};
  };

  Neighbourhood result;
  const std::size_t steps = count > 0 ? count - 1 : 0;
  std::vector<double> consecutive(steps);
  context.parallel(steps, [&](std::size_t k) { consecutive[k] = comparison.overlap(k, k + 1, 0); });
  double smallest = 1;
  for (std::uint32_t k = 0; k < steps; ++k) {
    result.edges.list.push_back(edge(k, k + 1, EdgeKind::sequential, consecutive[k]));
    smallest = std::min(smallest, consecutive[k]);
    if (consecutive[k] == 0) result.disconnected.push_back(k);
  }
  result.threshold =
      std::max(options.threshold.value_or(options.margin * smallest), options.min_threshold);

  auto pairs = meeting(boxes, options.resolution);
  std::erase_if(pairs, [](const Pair& p) { return p.second - p.first == 1; });
  std::vector<double> overlaps(pairs.size());
  context.parallel(pairs.size(), [&](std::size_t n) {
    overlaps[n] = comparison.overlap(pairs[n].first, pairs[n].second, result.threshold);
  });
  for (std::size_t n = 0; n < pairs.size(); ++n)
    if (overlaps[n] > result.threshold)
      result.edges.list.push_back(
          edge(pairs[n].first, pairs[n].second, EdgeKind::neighbour, overlaps[n]));
  std::ranges::sort(result.edges.list, {}, [](const Edge& e) { return Pair(e.i, e.j); });
  result.edges.segments = static_cast<std::uint32_t>(count);
  result.compared = pairs.size();
  return result;
}

Edges propose(std::size_t count, const Opener& segment, const Poses& poses,
              const OverlapOptions& options, const Comparison& comparison, Context& context) {
  if (count < 2)
    throw Error("got " + counted(count, "segments") +
                ", so there is nothing to register: cut shorter segments "
                "(segment.by_count: frames, "
                "segment.by_distance: length)");
  require_pose_each(poses, count);
  auto found = neighbours(count, segment, poses, options, comparison, context);
  for (const auto k : found.disconnected)
    context.warn("segments " + std::to_string(k) + " and " + std::to_string(k + 1) +
                 " follow each other but do not overlap");
  context.count("pairs whose boxes meet", found.compared);
  context.count("neighbours", found.edges.size() - (count - 1));
  return std::move(found.edges);
}

}  // namespace plumb::overlapping
