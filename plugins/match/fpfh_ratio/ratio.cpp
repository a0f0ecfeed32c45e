#include "ratio.hpp"

#include "shared/feature_space/two_nearest.hpp"

namespace plumb::match_fpfh_ratio {
namespace {

/// For each keypoint of `of` its match among `among`; none where it is not distinctive.
std::vector<std::uint32_t> matches_of(const Features& of, const Features& among,
                                      const RatioOptions& options) {
  const auto separation =
      static_cast<float>(options.min_separation * options.min_separation);  // squared
  const feature_space::Apart apart = [&](std::uint32_t first, std::uint32_t k) {
    return (among.points[first] - among.points[k]).squaredNorm() >= separation;
  };
  const auto found = feature_space::two_nearest(of.vectors, among.vectors, among.dimension, apart);
  std::vector<std::uint32_t> matches(found.size(), feature_space::none);
  for (std::size_t k = 0; k < found.size(); ++k)
    if (found[k].second != feature_space::none &&
        found[k].first_squared < options.ratio * options.ratio * found[k].second_squared)
      matches[k] = found[k].first;
  return matches;
}

}  // namespace

feature_space::Pairs distinctive_pairs(const Features& a, const Features& b,
                                       const RatioOptions& options) {
  const auto there = matches_of(a, b, options);
  const auto back = options.mutual ? matches_of(b, a, options) : std::vector<std::uint32_t>();
  feature_space::Pairs pairs;
  for (std::uint32_t i = 0; i < there.size(); ++i)
    if (there[i] != feature_space::none && (!options.mutual || back[there[i]] == i))
      pairs.emplace_back(i, there[i]);
  return pairs;
}

}  // namespace plumb::match_fpfh_ratio
