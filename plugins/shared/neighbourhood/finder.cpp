#include "shared/neighbourhood/finder.hpp"

namespace plumb::neighbourhood {

Finder::Finder(const Cloud& cloud, const SearchTree& tree, const Bounds& bounds)
    : cloud_(cloud), tree_(tree), bounds_(bounds) {
  if (bounds.most) found_.resize(*bounds.most);
}

const std::vector<Eigen::Vector3f>& Finder::around(std::size_t k) {
  const Eigen::Vector3f here = cloud_.point(k);
  points_.clear();
  if (!here.allFinite()) return points_;
  std::size_t count;
  if (bounds_.most) {
    count = tree_.nearest(here, *bounds_.most, found_.data());
    if (bounds_.radius) {
      const auto r = static_cast<float>(*bounds_.radius);
      while (count > 0 && found_[count - 1].squared_distance > r * r) --count;
    }
  } else {
    tree_.within(here, static_cast<float>(*bounds_.radius), found_, false);
    count = found_.size();
  }
  for (std::size_t m = 0; m < count; ++m) points_.push_back(cloud_.point(found_[m].index) - here);
  return points_;
}

}  // namespace plumb::neighbourhood
