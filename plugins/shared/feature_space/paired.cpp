#include "shared/feature_space/paired.hpp"

#include <string>

#include "plumb/data/error.hpp"

namespace plumb::feature_space {

void require_one_dimension(const Features& of_i, const Features& of_j) {
  if (of_i.dimension != of_j.dimension)
    throw Error("the features have " + std::to_string(of_i.dimension) + " and " +
                std::to_string(of_j.dimension) +
                " numbers; describe all segments by the same step");
}

Matches paired(const Features& of_i, const Features& of_j, const Pairs& pairs) {
  Matches matches;
  for (const auto& [i, j] : pairs) {
    matches.p.push_back(of_i.points[i]);
    matches.q.push_back(of_j.points[j]);
    matches.index_p.push_back(i);
    matches.index_q.push_back(j);
    matches.weight.push_back(1);
    matches.at_border.push_back((!of_i.at_border.empty() && of_i.at_border[i]) ||
                                (!of_j.at_border.empty() && of_j.at_border[j]));
    if (of_i.normals.empty() || of_j.normals.empty()) continue;
    matches.normal_p.push_back(of_i.normals[i]);
    matches.normal_q.push_back(of_j.normals[j]);
  }
  matches.found = static_cast<std::uint32_t>(matches.size());
  return matches;
}

}  // namespace plumb::feature_space
