#include "edge_state.hpp"

#include "plumb/data/error.hpp"

namespace plumb::solve_pose_graph {

EdgeState::EdgeState(const MatchedEdge& edge, const GraphOptions& options)
    : edge_(edge.edge), matches_(edge.matches), options_(options) {
  if (matches_->to_plane && matches_->normal_q.size() != matches_->size())
    throw Error("edge (" + std::to_string(edge_.i) + ", " + std::to_string(edge_.j) +
                ") has pairs for point-to-plane but no normals; put estimate.normals before the "
                "matching, or match with metric: point");
  double given = 0;
  for (std::size_t k = 0; k < pairs(); ++k) {
    centre_ += matches_->p[k].cast<double>();
    given += given_weight(k);
  }
  if (pairs() > 0) centre_ /= static_cast<double>(pairs());
  if (options_.max_edge_weight && given > *options_.max_edge_weight)
    share_ = *options_.max_edge_weight / given;
}

template <class Body>
void EdgeState::each_pair(const Pose& T_j_i, const Body& body) const {
  const Eigen::Matrix3d R = T_j_i.matrix();
  const Eigen::Vector3d t = T_j_i.translation;
  for (std::size_t k = 0; k < pairs(); ++k) {
    const Eigen::Vector3d p = matches_->p[k].cast<double>();
    const Eigen::Vector3d d = R * p + t - matches_->q[k].cast<double>();
    if (matches_->to_plane) {
      const double e = matches_->normal_q[k].cast<double>().dot(d);
      body(k, p, d, e * e);
    } else {
      body(k, p, d, d.squaredNorm());
    }
  }
}

void EdgeState::refresh(const Pose& T_j_i, const Hardness& hardness) {
  const double per_scale2 = 1 / (hardness.scale * hardness.scale);
  double squares = 0, weighted = 0, weights = 0;
  each_pair(T_j_i, [&](std::size_t, const auto&, const auto&, double r2) {
    const double w = loss_weight(pair_loss(), r2 * per_scale2);
    squares += r2;
    weighted += w * r2;
    weights += w;
  });
  // The edge's own weight looks at what its pairs' losses have left, so a half wrong edge may still
  // be kept by its right half.
  const double edge_rms = weights > 0 ? std::sqrt(weighted / weights) : 0;
  const double ratio = edge_rms / hardness.edge_scale;
  const double of_edge = loss_weight(edge_loss(), ratio * ratio);
  const double n = static_cast<double>(std::max<std::size_t>(pairs(), 1));
  rms_ = std::sqrt(squares / n);
  mean_weight_ = of_edge * weights / n;
  weighted_squares_ = of_edge * weighted;
  weight_sum_ = of_edge * weights;

  form_.about = {T_j_i, centre_};
  const double unit = share_ * of_edge / (options_.scale * options_.scale);
  const auto weight = [&](std::size_t k, double r2) {
    return unit * given_weight(k) * loss_weight(pair_loss(), r2 * per_scale2);
  };
  if (matches_->to_plane) {
    PlanePairSums sums;
    each_pair(T_j_i, [&](std::size_t k, const auto& p, const auto& d, double r2) {
      const Eigen::Vector3d normal = matches_->normal_q[k].cast<double>();
      sums.add(p - centre_, normal, normal.dot(d), weight(k, r2));
    });
    form_.factor = factor_of(sums.moments());
  } else {
    PointPairSums sums;
    each_pair(T_j_i, [&](std::size_t k, const auto& p, const auto& d, double r2) {
      sums.add(p - centre_, d, weight(k, r2));
    });
    form_.factor = factor_of(sums.moments());
  }
}

double EdgeState::cost(const Pose& T_j_i) const {
  const double per_scale2 = 1 / (options_.scale * options_.scale);
  double sum = 0;
  each_pair(T_j_i, [&](std::size_t k, const auto&, const auto&, double r2) {
    sum += given_weight(k) * loss(pair_loss(), r2 * per_scale2);
  });
  return share_ * sum;
}

}  // namespace plumb::solve_pose_graph
