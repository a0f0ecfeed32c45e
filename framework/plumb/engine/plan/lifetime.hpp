#pragma once
/// What a plan says, before it runs, on how long each step's results must live.

#include <cstdint>
#include <string>
#include <vector>

#include "plumb/pipeline/bind/plan.hpp"

namespace plumb {

/// How long the items of a step live.
enum class Keeping : std::uint8_t {
  passing,  ///< made anew whenever asked for: what is transient (frames), and large values (clouds)
            ///< that only one following step takes
  kept,     ///< made once, kept as long as someone may ask
  remembered,  ///< kept, and looked up in memory too when there is no store: the step may come
               ///< again with the same inputs
};

struct Lifetime {
  Keeping keeping = Keeping::kept;
  std::string why;  ///< for people: "large, and only voxels takes them"
};

/// For each step: the places in Plan::order, its own and later ones, whose items may ask for its
/// results, in order. Who draws on something that passes through asks all that this draws on.
std::vector<std::vector<std::size_t>> users_of(const Plan& plan);
/// The last of them: after it nobody asks any more.
std::vector<std::size_t> last_uses(const Plan& plan);

/// For each step: whether its items pass through, are kept, or are remembered too.
std::vector<Lifetime> keeping_of(const Plan& plan);

}  // namespace plumb
