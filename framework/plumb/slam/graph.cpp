#include "plumb/slam/graph.hpp"

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"

namespace plumb {

const char* name_of(EdgeKind kind) {
  switch (kind) {
    case EdgeKind::sequential:
      return "sequential";
    case EdgeKind::neighbour:
      return "neighbour";
    case EdgeKind::loop:
      return "loop";
  }
  return "?";
}

Matches select(const Matches& matches, const std::vector<std::uint32_t>& indices) {
  Matches result;
  const auto pick = [&](const auto& from, auto& to) {
    if (from.empty()) return;
    to.reserve(indices.size());
    for (const auto k : indices) to.push_back(from[k]);
  };
  pick(matches.p, result.p);
  pick(matches.q, result.q);
  pick(matches.index_p, result.index_p);
  pick(matches.index_q, result.index_q);
  pick(matches.weight, result.weight);
  pick(matches.at_border, result.at_border);
  pick(matches.normal_p, result.normal_p);
  pick(matches.normal_q, result.normal_q);
  result.found = matches.found;
  result.to_plane = matches.to_plane;
  return result;
}

void require_pose_each(const Poses& poses, std::size_t segments) {
  if (segments != poses.size())
    throw Error("got " + counted(segments, "segments") + " and " + counted(poses.size(), "poses") +
                ": wire poses of the same segments");
}

}  // namespace plumb
