#include "loop_consistency.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace plumb::prune_loop_consistency {
namespace {

/// What two loops near each other say of each other.
struct Comparison {
  std::uint32_t a, b;
  bool agree;
};

/// A comparison tells something where it is no coarser than so many times what two loops alone
/// allow.
constexpr double informative = 8;

/// So few loops may agree by chance.
constexpr int fewest_rivals = 3;

class Judge {
 public:
  Judge(const std::vector<Loop>& loops, const Poses& poses, const ConsistencyOptions& options)
      : loops_(loops),
        poses_(poses),
        options_(options),
        path_(poses.size(), 0),
        verdicts_(loops.size(), LoopVerdict::kept) {
    for (std::size_t k = 1; k < poses.size(); ++k)
      path_[k] =
          path_[k - 1] +
          (poses.T_world_segment[k].translation - poses.T_world_segment[k - 1].translation).norm();
  }

  std::vector<LoopVerdict> run() && {
    for (std::size_t k = 0; k < loops_.size(); ++k)
      if (!fits_odometry(loops_[k])) verdicts_[k] = LoopVerdict::against_odometry;
    drop_contradictions();
    return std::move(verdicts_);
  }

 private:
  double path(std::uint32_t a, std::uint32_t b) const { return std::abs(path_[a] - path_[b]); }
  double distance(std::uint32_t a, std::uint32_t b) const {
    return (poses_.T_world_segment[a].translation - poses_.T_world_segment[b].translation).norm();
  }

  bool fits_odometry(const Loop& loop) const {
    const Pose error = loop.T_i_j.inverse() * poses_.relative(loop.i, loop.j);
    const double length = path(loop.i, loop.j);
    // The way there and back swings round the farthest point between the ends, hence half of the
    // path as the lever.
    const double position =
        std::hypot(loop.sigma_translation,
                   options_.drift.position(length, 0.5 * std::min(length, 2 * extent(loop))));
    const double rotation = std::hypot(loop.sigma_rotation, options_.drift.rotation(length));
    return error.translation.norm() <= options_.max_deviation * position &&
           angle(error) <= options_.max_deviation * rotation;
  }

  /// [m] the farthest that the path between the ends leads away from them.
  double extent(const Loop& loop) const {
    double most = 0;
    const std::uint32_t step = std::max<std::uint32_t>(1, (loop.j - loop.i) / 32);
    for (std::uint32_t k = loop.i; k < loop.j; k += step)
      most = std::max(most, distance(loop.i, k));
    return most;
  }

  bool near(const Loop& a, const Loop& b) const {
    return path(a.i, b.i) <= options_.max_path_separation &&
           path(a.j, b.j) <= options_.max_path_separation;
  }

  /// e of the cycle i_a -> j_a -> j_b -> i_b -> i_a is the identity where both are right and the
  /// poses between exact. Nothing where so much path lies between them that it could not tell.
  std::optional<bool> agree(const Loop& a, const Loop& b) const {
    const Pose cycle =
        a.T_i_j * poses_.relative(a.j, b.j) * b.T_i_j.inverse() * poses_.relative(b.i, a.i);
    const double at_i = path(a.i, b.i), at_j = path(a.j, b.j);
    const double lever = distance(a.j, b.j) + distance(a.i, b.i);
    const double rotation = std::sqrt(
        std::pow(a.sigma_rotation, 2) + std::pow(b.sigma_rotation, 2) +
        std::pow(options_.drift.rotation(at_i), 2) + std::pow(options_.drift.rotation(at_j), 2));
    const double position =
        std::sqrt(std::pow(a.sigma_translation, 2) + std::pow(b.sigma_translation, 2) +
                  std::pow(options_.drift.position(at_i, distance(a.i, b.i)), 2) +
                  std::pow(options_.drift.position(at_j, distance(a.j, b.j)), 2) +
                  std::pow(std::hypot(a.sigma_rotation, b.sigma_rotation) * lever, 2));
    if (position > informative * std::hypot(a.sigma_translation, b.sigma_translation))
      return std::nullopt;
    return cycle.translation.norm() <= options_.max_deviation * position &&
           angle(cycle) <= options_.max_deviation * rotation;
  }

  /// All pairs of loops that lie near each other: loops in order of i, so that only a window of
  /// them is looked at.
  std::vector<Comparison> comparisons() const {
    std::vector<std::uint32_t> order;
    for (std::uint32_t k = 0; k < loops_.size(); ++k)
      if (verdicts_[k] == LoopVerdict::kept) order.push_back(k);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t k) { return loops_[k].i; });
    std::vector<Comparison> all;
    for (std::size_t x = 0; x < order.size(); ++x)
      for (std::size_t y = x + 1; y < order.size(); ++y) {
        const Loop &a = loops_[order[x]], &b = loops_[order[y]];
        if (path(a.i, b.i) > options_.max_path_separation) break;
        if (!near(a, b)) continue;
        if (const auto told = agree(a, b)) all.push_back({order[x], order[y], *told});
      }
    return all;
  }

  /// What the others say of each loop.
  struct Neighbours {
    std::vector<std::uint32_t> agree, disagree;
  };

  void drop_contradictions() {
    std::vector<Neighbours> of(loops_.size());
    for (const Comparison& one : comparisons()) {
      (one.agree ? of[one.a].agree : of[one.a].disagree).push_back(one.b);
      (one.agree ? of[one.b].agree : of[one.b].disagree).push_back(one.a);
    }
    drop_minorities(of);
    drop_undecided(of);
    for (std::uint32_t k = 0; k < loops_.size(); ++k)
      if (verdicts_[k] == LoopVerdict::kept && count(of[k].agree, LoopVerdict::kept) == 0 &&
          options_.drift.position(path(loops_[k].i, loops_[k].j), extent(loops_[k])) >
              options_.max_unconfirmed_sigma)
        verdicts_[k] = LoopVerdict::alone;
  }

  int count(const std::vector<std::uint32_t>& loops, LoopVerdict verdict) const {
    return static_cast<int>(
        std::ranges::count_if(loops, [&](std::uint32_t k) { return verdicts_[k] == verdict; }));
  }

  void drop_minorities(const std::vector<Neighbours>& of) {
    std::vector<int> told(loops_.size(), 0), agreed(loops_.size(), 0);
    for (std::uint32_t k = 0; k < loops_.size(); ++k) {
      agreed[k] = static_cast<int>(of[k].agree.size());
      told[k] = agreed[k] + static_cast<int>(of[k].disagree.size());
    }
    for (;;) {
      std::uint32_t worst = 0;
      double least = 2;
      for (std::uint32_t k = 0; k < loops_.size(); ++k) {
        if (verdicts_[k] != LoopVerdict::kept || told[k] == 0) continue;
        const double share = static_cast<double>(agreed[k]) / told[k];
        if (share < least) least = share, worst = k;
      }
      if (least >= options_.min_agreement) break;
      verdicts_[worst] = LoopVerdict::against_loops;
      for (const std::uint32_t other : of[worst].agree) --told[other], --agreed[other];
      for (const std::uint32_t other : of[worst].disagree) --told[other];
    }
  }

  /// The dropped loops that disagree with `loop` and have another dropped one on their side.
  std::vector<std::uint32_t> rivals(std::uint32_t loop, const std::vector<Neighbours>& of) const {
    std::vector<std::uint32_t> rivals;
    for (const std::uint32_t other : of[loop].disagree)
      if (verdicts_[other] == LoopVerdict::against_loops &&
          count(of[other].agree, LoopVerdict::against_loops) > 0)
        rivals.push_back(other);
    return rivals;
  }

  /// Judged by what was kept and dropped before, so that no order matters. Then those of which half
  /// of the loops that agree with them are undecided.
  void drop_undecided(const std::vector<Neighbours>& of) {
    std::vector<std::uint32_t> undecided;
    for (std::uint32_t k = 0; k < loops_.size(); ++k) {
      if (verdicts_[k] != LoopVerdict::kept) continue;
      const auto against = rivals(k, of);
      const int support = 1 + count(of[k].agree, LoopVerdict::kept);
      if (static_cast<int>(against.size()) < fewest_rivals ||
          static_cast<double>(against.size()) <= options_.max_rival_share * support)
        continue;
      undecided.push_back(k);
      undecided.insert(undecided.end(), against.begin(), against.end());
    }
    while (!undecided.empty()) {
      for (const std::uint32_t k : undecided) verdicts_[k] = LoopVerdict::undecided;
      undecided.clear();
      for (std::uint32_t k = 0; k < loops_.size(); ++k) {
        if (verdicts_[k] != LoopVerdict::kept) continue;
        const int doubtful = count(of[k].agree, LoopVerdict::undecided);
        if (doubtful > 0 && doubtful >= count(of[k].agree, LoopVerdict::kept))
          undecided.push_back(k);
      }
    }
  }

  const std::vector<Loop>& loops_;
  const Poses& poses_;
  const ConsistencyOptions& options_;
  std::vector<double> path_;
  std::vector<LoopVerdict> verdicts_;
};

}  // namespace

double DriftModel::rotation(double path) const {
  return rotation_per_metre * std::sqrt(path * std::min(path, correlation_length));
}

double DriftModel::position(double path, double distance) const {
  return std::hypot(translation_per_metre * std::sqrt(path * std::min(path, correlation_length)),
                    rotation(path) * distance / std::sqrt(3.0));
}

std::vector<LoopVerdict> judge_loops(const std::vector<Loop>& loops, const Poses& poses,
                                     const ConsistencyOptions& options) {
  return Judge(loops, poses, options).run();
}

}  // namespace plumb::prune_loop_consistency
