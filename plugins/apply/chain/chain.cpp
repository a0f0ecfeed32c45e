#include "chain.hpp"

#include <cmath>

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"

namespace plumb::apply_chain {
namespace {

constexpr std::size_t none = ~std::size_t{0};

/// The edge that places each segment; none where no edge ends.
std::vector<std::size_t> placing_edges(std::size_t segments, const Edges& edges,
                                       std::span<const Registration> registrations) {
  std::vector<std::size_t> placing(segments, none);
  for (std::size_t k = 0; k < edges.size(); ++k) {
    std::size_t& best = placing[edges.list[k].j];
    const auto rank = [&](std::size_t e) {
      return std::pair(registrations[e].accepted, edges.list[e].i);
    };
    if (best == none || rank(best) < rank(k)) best = k;
  }
  return placing;
}

}  // namespace

Chained chained(const Poses& initial, const Edges& edges,
                std::span<const Registration> registrations, const ChainOptions& options) {
  const std::size_t count = initial.size();
  if (edges.segments != count || edges.size() != registrations.size())
    throw Error("got " + counted(count, "poses") + ", but the registrations are of " +
                counted(edges.segments, "segments") + "; wire poses of the same segments");
  Chained result;
  std::vector<std::uint8_t> touched(count, 0);
  Matrix6d weak = Matrix6d::Zero();
  weak.diagonal().head<3>().setConstant(std::pow(options.weak_translation_sigma, -2));
  weak.diagonal().tail<3>().setConstant(std::pow(options.weak_rotation_sigma, -2));

  std::vector<Pose> T_i_j(edges.size());
  result.constraints.planar = true;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const Edge& e = edges.list[k];
    const Registration& r = registrations[k];
    touched[e.i] = touched[e.j] = 1;
    T_i_j[k] = r.accepted ? r.T_i_j : initial.relative(e.i, e.j);
    result.replaced += !r.accepted;
    const bool known = r.accepted && !r.information.isZero(0);
    result.constraints.relative.push_back(constraint_of(e, T_i_j[k], known ? r.information : weak));
    result.constraints.planar = result.constraints.planar && in_plane(T_i_j[k]);
  }

  const auto placing = placing_edges(count, edges, registrations);
  result.poses = initial;
  auto& poses = result.poses.T_world_segment;
  std::size_t last = none;  // placed before
  for (std::size_t j = 0; j < count; ++j) {
    if (!touched[j]) continue;
    if (placing[j] != none) {
      poses[j] = poses[edges.list[placing[j]].i] * T_i_j[placing[j]];
    } else if (last != none) {
      poses[j] = poses[last] * initial.relative(last, j);
      ++result.starts;
    }
    for (std::size_t k = last + 1; last != none && k < j; ++k) {
      const double share = static_cast<double>(k - last) / static_cast<double>(j - last);
      poses[k] = interpolate(poses[last], poses[j], share);
      ++result.interpolated;
    }
    for (std::size_t k = 0; k < j && last == none; ++k)
      poses[k] = poses[j] * initial.relative(j, k);
    last = j;
  }
  for (std::size_t k = last + 1; last != none && k < count; ++k)
    poses[k] = poses[last] * initial.relative(last, k);
  return result;
}

}  // namespace plumb::apply_chain
