#include "plumb/slam/segment.hpp"

#include <mutex>
#include <optional>

namespace plumb {

struct LazyTree::State {
  std::once_flag once;
  std::optional<SearchTree> tree;
};

std::shared_ptr<LazyTree::State> LazyTree::make() { return std::make_shared<State>(); }

const SearchTree& LazyTree::of(const Cloud& cloud) const {
  std::call_once(state_->once, [&] {
    state_->tree.emplace(cloud.x.data(), cloud.y.data(), cloud.z.data(), cloud.size());
  });
  return *state_->tree;
}

std::vector<Eigen::Vector3f> FrameRange::origins() const {
  std::vector<Eigen::Vector3f> origins;
  for (const Pose& pose : T_segment_frame) origins.push_back(pose.translation.cast<float>());
  return origins;
}

Segment Segment::with(Cloud other, std::vector<std::uint16_t> frames) const {
  Segment result;
  result.range = range;
  result.centroid = centroid_of(other);
  result.box = box_of(other);
  result.cloud = std::move(other);
  result.frame = std::move(frames);
  return result;
}

Segment Segment::selected(const std::vector<std::uint32_t>& indices) const {
  std::vector<std::uint16_t> frames;
  frames.reserve(indices.size());
  for (const auto k : indices) frames.push_back(frame[k]);
  return with(select(cloud, indices), std::move(frames));
}

}  // namespace plumb
