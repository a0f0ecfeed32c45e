#include "closer.hpp"

namespace plumb {

std::vector<std::uint32_t> closer(const Matches& matches, const Pose& T_i_j, double max) {
  const Motion i_from_j(T_i_j);
  const auto squared_max = static_cast<float>(max * max);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t k = 0; k < matches.size(); ++k)
    if ((matches.p[k] - i_from_j * matches.q[k]).squaredNorm() <= squared_max) kept.push_back(k);
  return kept;
}

}  // namespace plumb
