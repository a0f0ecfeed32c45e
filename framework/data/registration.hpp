#pragma once
/// How one cloud was laid onto another: the result of a registration, one per edge.

#include "plumb/data/type.hpp"

namespace plumb {

/// The pose that a registration found for an edge, and how good it is.
struct Registration {
  Pose T_i_j;                                       ///< maps j's coordinates to i's
  Matrix6d information = Matrix6d::Zero();          ///< translation first, then rotation; zero: nothing known
  std::uint32_t iterations = 0;                     ///< of the search for the nearest pairs
  std::uint32_t pairs = 0;                          ///< in the last iteration
  float mae = 0;                                    ///< mean distance of those pairs [m]
  float overlap = 0;                                ///< share of j's points that have a pair, 0 to 1
  bool accepted = false;                            ///< whether it passed the step's own tests
};

template <> const Type& type_of<Registration>();

template <class Archive, class T>
  requires std::is_same_v<std::remove_const_t<T>, Registration>
void fields(Archive& a, T& r) {
  a(r.T_i_j, r.information, r.iterations, r.pairs, r.mae, r.overlap, r.accepted);
}

}  // namespace plumb
