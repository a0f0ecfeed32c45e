#include "graph_text.hpp"

#include <charconv>
#include <cmath>

#include "plumb/slam/geometry/pair_moments.hpp"

namespace plumb::write_graph {
namespace {

PairForm form_of(const Matches& matches, const Pose& T_j_i) {
  PairForm form;
  form.about.T_j_i = T_j_i;
  for (const auto& p : matches.p)
    form.about.centre += p.cast<double>() / static_cast<double>(matches.size());
  PointPairSums points;
  PlanePairSums planes;
  const bool to_plane = matches.to_plane && matches.normal_q.size() == matches.size();
  for (std::size_t k = 0; k < matches.size(); ++k) {
    const Eigen::Vector3d p = matches.p[k].cast<double>();
    const Eigen::Vector3d d = T_j_i * p - matches.q[k].cast<double>();
    const double w = matches.weight.empty() ? 1 : static_cast<double>(matches.weight[k]);
    if (to_plane) {
      const Eigen::Vector3d n = matches.normal_q[k].cast<double>();
      planes.add(p - form.about.centre, n, n.dot(d), w);
    } else {
      points.add(p - form.about.centre, d, w);
    }
  }
  form.factor = factor_of(to_plane ? planes.moments() : points.moments());
  return form;
}

void put(std::string& text, double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value == 0 ? 0.0 : value).ptr;
  text += ' ';
  text.append(buffer, end);
}
void put(std::string& text, const Pose& pose) {
  for (const double v : pose.translation) put(text, v);
  for (const double v :
       {pose.rotation.x(), pose.rotation.y(), pose.rotation.z(), pose.rotation.w()})
    put(text, v);
}
void put_planar(std::string& text, const Pose& pose) {
  put(text, pose.translation.x());
  put(text, pose.translation.y());
  put(text, 2 * std::atan2(pose.rotation.z(), pose.rotation.w()));
}

}  // namespace

std::optional<RelativePose> constraint_of(const Edge& edge, const Matches& matches,
                                          const Pose& T_i_j, std::optional<double> noise) {
  if (matches.size() < 3) return std::nullopt;
  const PairForm form = form_of(matches, T_i_j.inverse());
  const Pose T_j_i = fitted(form);
  const Eigen::Matrix3d R = T_j_i.matrix();
  const double rows = (matches.to_plane ? 1.0 : 3.0) * static_cast<double>(matches.size());
  const double left = form.residual(R, T_j_i.translation).squaredNorm() / std::max(1.0, rows - 6);
  const double sigma2 = noise ? *noise * *noise : std::max(left, 1e-6);

  // T_i_j moves to T_i_j (exp(w), v), so T_j_i moves to (exp(-w) R, exp(-w) t - v), and w = 2
  // q.vec.
  const auto by = form.jacobian(R);
  Eigen::Matrix<double, 13, 6> jacobian;
  jacobian << -by.leftCols<3>(),
      2 * (by.leftCols<3>() * cross_matrix(T_j_i.translation) - by.rightCols<3>() * R.transpose());
  Matrix6d information = jacobian.transpose() * jacobian / sigma2;
  information = (0.5 * (information + information.transpose())).eval();
  return RelativePose{edge.i, edge.j, T_j_i.inverse(), information};
}

std::string g2o_text(const Poses& poses, const Constraints& constraints) {
  std::string text;
  const auto id = [&](std::size_t k) {
    return " " + std::to_string(constraints.ids.empty() ? k : constraints.ids[k]);
  };
  const bool planar = constraints.planar;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    text += (planar ? "VERTEX_SE2" : "VERTEX_SE3:QUAT") + id(k);
    planar ? put_planar(text, poses.T_world_segment[k]) : put(text, poses.T_world_segment[k]);
    text += '\n';
  }
  if (poses.size() > 0) text += "FIX" + id(0) + '\n';
  for (const auto& r : constraints.relative) {
    text += (planar ? "EDGE_SE2" : "EDGE_SE3:QUAT") + id(r.i) + id(r.j);
    planar ? put_planar(text, r.T_i_j) : put(text, r.T_i_j);
    const std::vector<int> axes =
        planar ? std::vector<int>{0, 1, 5} : std::vector<int>{0, 1, 2, 3, 4, 5};
    for (std::size_t a = 0; a < axes.size(); ++a)
      for (std::size_t b = a; b < axes.size(); ++b) {
        // A planar file has the angle where space has q.vec, which is half of it.
        const double scale = planar ? (axes[a] == 5 ? 0.5 : 1.0) * (axes[b] == 5 ? 0.5 : 1.0) : 1.0;
        put(text, scale * r.information(axes[a], axes[b]));
      }
    text += '\n';
  }
  return text;
}

}  // namespace plumb::write_graph
