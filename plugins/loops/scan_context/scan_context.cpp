#include "scan_context.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb::loops_scan_context {

ScanContext scan_context(const Cloud& cloud, const Pose& T_world_segment,
                         const ContextOptions& options) {
  const Eigen::Matrix3f R_world_segment = T_world_segment.matrix().cast<float>();
  const auto range = static_cast<float>(options.max_range),
             ground = static_cast<float>(options.sensor_height);
  const auto rings = static_cast<Eigen::Index>(options.rings),
             sectors = static_cast<Eigen::Index>(options.sectors);
  constexpr float turn = 2 * std::numbers::pi_v<float>;
  Eigen::MatrixXf heights = Eigen::MatrixXf::Constant(rings, sectors, -1.f);  // -1: no point
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const Eigen::Vector3f p = R_world_segment * cloud.point(k);
    const float distance = std::hypot(p.x(), p.y());
    if (!(distance < range) || !std::isfinite(p.z())) continue;
    const auto ring = static_cast<Eigen::Index>(distance / range * static_cast<float>(rings));
    const float share = (std::atan2(p.y(), p.x()) + turn / 2) / turn;
    const auto sector = static_cast<Eigen::Index>(share * static_cast<float>(sectors));
    float& height =
        heights(std::min(ring, rings - 1), std::clamp<Eigen::Index>(sector, 0, sectors - 1));
    height = std::max({height, p.z() + ground, 0.f});
  }
  ScanContext context;
  context.ring_key =
      (heights.array() >= 0.f).cast<float>().rowwise().sum() / static_cast<float>(sectors);
  context.columns = heights.cwiseMax(0.f);
  context.filled.resize(options.sectors);
  for (Eigen::Index s = 0; s < sectors; ++s) {
    const float length = context.columns.col(s).norm();
    context.filled[static_cast<std::size_t>(s)] = length > 0;
    if (length > 0) context.columns.col(s) /= length;
  }
  return context;
}

double similarity(const ScanContext& a, const ScanContext& b) {
  const Eigen::MatrixXf cosines = a.columns.transpose() * b.columns;
  const std::size_t sectors = a.filled.size();
  double best = 0;
  for (std::size_t turn = 0; turn < sectors; ++turn) {
    double sum = 0;
    std::size_t counted = 0;
    for (std::size_t s = 0; s < sectors; ++s) {
      const std::size_t other = s + turn < sectors ? s + turn : s + turn - sectors;
      if (!a.filled[s] && !b.filled[other]) continue;
      ++counted;
      sum += static_cast<double>(
          cosines(static_cast<Eigen::Index>(s), static_cast<Eigen::Index>(other)));
    }
    if (counted > 0) best = std::max(best, sum / static_cast<double>(counted));
  }
  return std::min(best, 1.0);
}

}  // namespace plumb::loops_scan_context
