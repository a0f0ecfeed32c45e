#include "distance.hpp"

namespace plumb::filter_distance {

Shell within_shell(const Cloud& cloud, float least, float most) {
  const float low = least * least, high = most * most;
  std::vector<std::uint32_t> kept(cloud.size());
  std::size_t count = 0, farther = 0;
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const float square =
        cloud.x[k] * cloud.x[k] + cloud.y[k] * cloud.y[k] + cloud.z[k] * cloud.z[k];
    kept[count] = static_cast<std::uint32_t>(k);
    count += square >= low && square <= high;
    farther += square > high;
  }
  Shell result;
  result.farther = farther;
  result.nearer = cloud.size() - count - farther;
  if (count == cloud.size()) {
    result.cloud = cloud;
  } else {
    kept.resize(count);
    result.cloud = select(cloud, kept);
  }
  return result;
}

}  // namespace plumb::filter_distance
