#include "collect.hpp"

namespace plumb {

Relations collected(const Edges& edges, std::span<const Registration> registrations,
                    double inflate) {
  Relations relations;
  relations.planar = true;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const Registration& r = registrations[k];
    if (!r.accepted || r.information.isZero(0)) continue;
    relations.relative.push_back(
        relation_of(edges.list[k], r.T_i_j, r.information / (inflate * inflate)));
    relations.planar = relations.planar && in_plane(r.T_i_j);
  }
  relations.planar = relations.planar && !relations.relative.empty();
  return relations;
}

}  // namespace plumb
