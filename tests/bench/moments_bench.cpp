/// The cost of an edge with its derivatives, once for each step of the solver: by moments, beside
/// pair by pair; and summing the moments, once for each round. Per pair of an edge with 1,000
/// pairs.

#include <vector>

#include "plumb/plugin/context.hpp"
#include "plumb/slam/geometry/pair_moments.hpp"
#include "scene.hpp"

namespace plumb::bench {
namespace {

constexpr std::size_t pairs = 1000;

struct EdgeOfPairs {
  std::vector<Eigen::Vector3d> p, q;
  Pose T_j_i{exp_rotation({0.01, -0.02, 0.1}), {3, 1, 0.2}};
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();

  EdgeOfPairs() {
    Random random(3);
    const auto in_box = [&](double half) {
      Eigen::Vector3d v;
      for (int c = 0; c < 3; ++c) v[c] = half * (2 * random.uniform() - 1);
      return v;
    };
    for (std::size_t k = 0; k < pairs; ++k) {
      p.push_back(in_box(30));
      q.push_back(T_j_i * p.back() + in_box(0.2));
      centre += p.back() / static_cast<double>(pairs);
    }
  }
  PairForm summed() const {
    PointPairSums sums;
    const Eigen::Matrix3d r = T_j_i.matrix();
    for (std::size_t k = 0; k < pairs; ++k)
      sums.add(p[k] - centre, r * p[k] + T_j_i.translation - q[k], 1);
    return {{T_j_i, centre}, factor_of(sums.moments())};
  }
};

void summing(benchmark::State& state) {
  const EdgeOfPairs edge;
  for (auto _ : state) benchmark::DoNotOptimize(edge.summed());
  per(state, "pair", pairs);
}
BENCHMARK(summing)->Name("moments, summing/ours")->Unit(benchmark::kMicrosecond);

void by_moments(benchmark::State& state) {
  const PairForm form = EdgeOfPairs().summed();
  Pose at = form.about.T_j_i;
  for (auto _ : state) {
    benchmark::DoNotOptimize(at);
    const Eigen::Matrix3d r = at.matrix();
    benchmark::DoNotOptimize(form.residual(r, at.translation));
    benchmark::DoNotOptimize(form.jacobian(r));
  }
  per(state, "pair", pairs);
}
BENCHMARK(by_moments)->Name("edge cost/ours")->Unit(benchmark::kMicrosecond);

/// The same three rows a pair: d = R p + t - q and its derivative [1, -R [p]x].
void pair_by_pair(benchmark::State& state) {
  const EdgeOfPairs edge;
  std::vector<Eigen::Vector3d> residuals(pairs);
  std::vector<Eigen::Matrix<double, 3, 6>> jacobians(pairs);
  Pose at = edge.T_j_i;
  for (auto _ : state) {
    benchmark::DoNotOptimize(at);
    const Eigen::Matrix3d r = at.matrix();
    for (std::size_t k = 0; k < pairs; ++k) {
      residuals[k] = r * edge.p[k] + at.translation - edge.q[k];
      jacobians[k].leftCols<3>().setIdentity();
      jacobians[k].rightCols<3>().noalias() = -r * cross_matrix(edge.p[k]);
    }
    benchmark::DoNotOptimize(residuals.data());
    benchmark::DoNotOptimize(jacobians.data());
    benchmark::ClobberMemory();
  }
  per(state, "pair", pairs);
}
BENCHMARK(pair_by_pair)->Name("edge cost/pair by pair")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace plumb::bench
