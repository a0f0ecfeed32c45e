#include "collect.hpp"

namespace plumb::constraints_collect {

Constraints collected(const Edges& edges, std::span<const Registration> registrations,
                      double inflate) {
  Constraints constraints;
  constraints.planar = true;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const Registration& r = registrations[k];
    if (!r.accepted || r.information.isZero(0)) continue;
    constraints.relative.push_back(
        constraint_of(edges.list[k], r.T_i_j, r.information / (inflate * inflate)));
    constraints.planar = constraints.planar && in_plane(r.T_i_j);
  }
  constraints.planar = constraints.planar && !constraints.relative.empty();
  return constraints;
}

}  // namespace plumb::constraints_collect
