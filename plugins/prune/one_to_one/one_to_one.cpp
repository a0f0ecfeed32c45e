#include "one_to_one.hpp"

#include <pcl/registration/correspondence_rejection_one_to_one.h>

#include <algorithm>

#include "plumb/data/error.hpp"

namespace plumb::prune_one_to_one {
namespace {

/// Of the pairs with the same point the closest; `point` has that of each pair.
::pcl::Correspondences closest(::pcl::Correspondences pairs,
                               const std::vector<std::uint32_t>& point) {
  for (auto& pair : pairs)
    pair.index_match =
        static_cast<::pcl::index_t>(point[static_cast<std::size_t>(pair.index_query)]);
  ::pcl::registration::CorrespondenceRejectorOneToOne reject;
  ::pcl::Correspondences kept;
  reject.getRemainingCorrespondences(pairs, kept);
  return kept;
}

}  // namespace

std::vector<std::uint32_t> one_to_one(const Matches& matches, const Pose& T_i_j) {
  if (matches.index_p.size() != matches.size() || matches.index_q.size() != matches.size())
    throw Error("the pairs do not name their points: wire what a step of the family match gives");
  const Motion motion(T_i_j);
  ::pcl::Correspondences pairs;
  for (std::size_t k = 0; k < matches.size(); ++k)
    pairs.emplace_back(static_cast<::pcl::index_t>(k), 0,
                       (matches.p[k] - motion * matches.q[k]).norm());
  pairs = closest(closest(std::move(pairs), matches.index_q), matches.index_p);
  std::vector<std::uint32_t> kept;
  for (const auto& pair : pairs) kept.push_back(static_cast<std::uint32_t>(pair.index_query));
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace plumb::prune_one_to_one
