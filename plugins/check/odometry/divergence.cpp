#include "divergence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "shared/selection/median.hpp"

namespace plumb::check_odometry {
namespace {

struct Pair {
  std::uint32_t a, b;
  Pose odometry;               ///< T_a_b
  std::optional<Pose> better;  ///< what the scans say instead
  std::vector<Pose>
      followed;  ///< where it was followed frame by frame: T_a_k of the frames a + 1 .. b
};

/// The motion that fits best of those tried; of equals the first.
struct Fit {
  Pose motion;
  double misfit = std::numeric_limits<double>::infinity();

  void take(ScanTarget& target, const std::vector<Eigen::Vector3f>& source, const Pose& aligned) {
    if (const double is = target.misfit(source, aligned); is < misfit)
      motion = aligned, misfit = is;
  }
  /// In a sharp turn a start is too far off in yaw: others beside it are tried.
  void take_turned(ScanTarget& target, const std::vector<Eigen::Vector3f>& source,
                   const Pose& start) {
    for (const double yaw : {-0.15, 0.15, -0.3, 0.3})
      take(
          target, source,
          target.aligned(source, start * Pose(exp_rotation({0, 0, yaw}), Eigen::Vector3d::Zero())));
  }
};

Pose scaled(const Pose& motion, double factor) {
  return {exp_rotation(factor * log_rotation(motion.rotation)), factor * motion.translation};
}

class Checker {
 public:
  Checker(const Trajectory& odometry,
          const std::function<std::shared_ptr<const Frame>(std::size_t)>& open,
          const DivergenceOptions& options)
      : odometry_(odometry), open_(open), options_(options) {
    // Where the odometry stands still the sensor may not: each frame counts for at least the usual
    // motion.
    auto path = travelled(odometry);
    std::vector<double> steps(path.size(), 0);
    std::adjacent_difference(path.begin(), path.end(), steps.begin());
    std::vector<double> sorted = steps;
    std::ranges::sort(sorted);
    const double usual = sorted.empty() ? 0 : sorted[sorted.size() * 3 / 4];
    for (std::size_t k = 1; k < path.size(); ++k) path[k] = path[k - 1] + std::max(steps[k], usual);
    std::vector<double> times;
    for (std::size_t k = 1; k < odometry.size(); ++k)
      times.push_back(odometry.stamps[k] - odometry.stamps[k - 1]);
    usual_time_ = selection::median(std::move(times));
    for (std::uint32_t a = 0, b = 1; b < odometry.size(); ++b)
      if (path[b] - path[a] >= options.min_path_length || b - a >= options.max_frames ||
          b + 1 == odometry.size()) {
        pairs_.push_back(
            {a, b, odometry.T_world_frame[a].inverse() * odometry.T_world_frame[b], {}, {}});
        a = b;
      }
  }

  CheckedOdometry run(Context& context) {
    context.parallel(pairs_.size(), [&](std::size_t n) {
      pairs_[n].better = judge(n, n > 0 ? &pairs_[n - 1].odometry : nullptr);
    });
    // Where a motion was found wrong, the scans are followed frame by frame until the odometry
    // agrees with them again.
    for (std::size_t n = 1; n < pairs_.size(); ++n)
      if (pairs_[n - 1].better) follow(n, last_motion(pairs_[n - 1]), false);
    // It may have failed earlier, where it fitted as badly but no other motion was near enough, as
    // in a sharp turn.
    for (std::size_t n = pairs_.size(); n-- > 1;)
      if (pairs_[n].better && !pairs_[n - 1].better && misfits(pairs_[n - 1]))
        follow(n - 1, first_motion(pairs_[n]), true);
    drop_single();
    CheckedOdometry result;
    result.compared = static_cast<std::uint32_t>(pairs_.size());
    result.divergences = divergences();
    result.trajectory = corrected();
    return result;
  }

 private:
  /// The motion that the scans prefer to the odometry's by far, if any. `before` is the motion of
  /// the pair before.
  std::optional<Pose> judge(std::size_t n, const Pose* before) const {
    const Pair& pair = pairs_[n];
    ScanTarget target(open_(pair.a)->cloud, options_.scans);
    const auto source = asked_points(open_(pair.b)->cloud, options_.scans);
    std::vector<Pose> rivals{scaled(pair.odometry, 0.5), scaled(pair.odometry, 2), Pose()};
    if (before) {
      const double frames = static_cast<double>(pair.b - pair.a) /
                            static_cast<double>(pairs_[n - 1].b - pairs_[n - 1].a);
      rivals.push_back(scaled(*before, frames));
    }
    if (n + 1 < pairs_.size()) {
      const double frames = static_cast<double>(pair.b - pair.a) /
                            static_cast<double>(pairs_[n + 1].b - pairs_[n + 1].a);
      rivals.push_back(scaled(pairs_[n + 1].odometry, frames));
    }
    const double given = target.misfit(source, pair.odometry);
    double good = 0.25 * options_.scans.max_distance;
    const bool rivalled = std::ranges::any_of(rivals, [&](const Pose& rival) {
      return differs(rival, pair.odometry, 0.5) && target.misfit(source, rival) < given;
    });
    if ((!rivalled && given <= good) || gap(pair)) return std::nullopt;
    good = std::max(good, 1.3 * best_neighbour_misfit(n));
    // Align from where each hypothesis begins: one that fits no better than the rest may still
    // begin near enough.
    const Pose own = target.aligned(source, pair.odometry);
    Fit best{pair.odometry, given};
    best.take(target, source, own);
    for (const Pose& rival : rivals) best.take(target, source, target.aligned(source, rival));
    if (best.misfit > good || !differs(best.motion, pair.odometry, 1)) return std::nullopt;
    // Drift within the reach of ICP is not what is looked for: the odometry must fit much worse as
    // it stands, and also where ICP takes it, unless that is the same place.
    const double own_misfit = differs(own, best.motion, 0.5) ? target.misfit(source, own) : given;
    if (best.misfit > options_.max_misfit_ratio * std::min(given, own_misfit)) return std::nullopt;
    return best.motion;
  }

  /// What the odometry's misfit is beside pair n, on the side where it is less: in a corner also
  /// right motions fit badly.
  double best_neighbour_misfit(std::size_t n) const {
    double least = options_.scans.max_distance;
    for (const std::size_t beside : {n - 1, n + 1}) {
      if (beside >= pairs_.size()) continue;
      ScanTarget target(open_(pairs_[beside].a)->cloud, options_.scans);
      least = std::min(least,
                       target.misfit(asked_points(open_(pairs_[beside].b)->cloud, options_.scans),
                                     pairs_[beside].odometry));
    }
    return least;
  }

  static Pose last_motion(const Pair& pair) {
    return pair.followed.size() > 1
               ? pair.followed[pair.followed.size() - 2].inverse() * pair.followed.back()
               : scaled(*pair.better, 1.0 / (pair.b - pair.a));
  }
  static Pose first_motion(const Pair& pair) {
    return pair.followed.empty() ? scaled(*pair.better, 1.0 / (pair.b - pair.a))
                                 : pair.followed.front();
  }

  /// Whether the odometry's motion does not fit.
  bool misfits(const Pair& pair) const {
    ScanTarget target(open_(pair.a)->cloud, options_.scans);
    return !gap(pair) && target.misfit(asked_points(open_(pair.b)->cloud, options_.scans),
                                       pair.odometry) > 0.25 * options_.scans.max_distance;
  }

  /// Registers each frame of pair n to the one before, from the odometry's motion and from the last
  /// motion found (`velocity` at first), whichever ends better. `back`: before what was found
  /// wrong, where only a good fit counts.
  void follow(std::size_t n, Pose velocity, bool back) {
    Pair& pair = pairs_[n];
    std::vector<Pose> followed;
    bool lost = false;
    Pose T_a_k;
    for (std::uint32_t k = pair.a + 1; k <= pair.b; ++k) {
      ScanTarget target(open_(k - 1)->cloud, options_.scans);
      const auto source = asked_points(open_(k)->cloud, options_.scans);
      const Pose given = odometry_.T_world_frame[k - 1].inverse() * odometry_.T_world_frame[k];
      Fit best;
      for (const Pose& start : {given, velocity})
        best.take(target, source, target.aligned(source, start));
      const double fits = 0.25 * options_.scans.max_distance;
      Fit turned = best;
      for (const Pose& start : {given, velocity})
        if (turned.misfit > fits) turned.take_turned(target, source, start);
      if (turned.misfit <= fits) best = turned;
      velocity = best.motion;
      // Where nothing fits, the scans know no better than the odometry.
      lost =
          lost || best.misfit > (back ? fits : std::max(fits, 0.8 * target.misfit(source, given)));
      T_a_k = T_a_k * velocity;
      followed.push_back(T_a_k);
    }
    if (lost || !differs(T_a_k, pair.odometry, 1)) {
      pair.better.reset();
      return;
    }
    pair.better = T_a_k;
    pair.followed = std::move(followed);
  }

  /// Frames are missing between the two: they lie far apart with right, and share too little to
  /// tell.
  bool gap(const Pair& pair) const {
    const double time = odometry_.stamps[pair.b] - odometry_.stamps[pair.a];
    return time > 2.5 * usual_time_ * (pair.b - pair.a);
  }

  bool differs(const Pose& x, const Pose& y, double factor) const {
    const Pose d = x.inverse() * y;
    return d.translation.norm() > factor * options_.min_translation ||
           angle(d) > factor * options_.min_rotation;
  }

  void drop_single() {
    for (std::size_t n = 0; n < pairs_.size(); ++n) {
      const bool before = n > 0 && pairs_[n - 1].better,
                 after = n + 1 < pairs_.size() && pairs_[n + 1].better;
      if (pairs_[n].better && !before && !after &&
          !differs(*pairs_[n].better, pairs_[n].odometry, options_.single_factor))
        pairs_[n].better.reset();
    }
  }

  std::vector<Divergence> divergences() const {
    std::vector<Divergence> all;
    for (const Pair& pair : pairs_) {
      if (!pair.better) continue;
      if (all.empty() || all.back().last != pair.a) all.push_back({pair.a, pair.b});
      Divergence& d = all.back();
      const Pose off = pair.better->inverse() * pair.odometry;
      d.last = pair.b;
      d.odometry_path += pair.odometry.translation.norm(),
          d.registered_path += pair.better->translation.norm();
      d.odometry_turn += angle(pair.odometry), d.registered_turn += angle(*pair.better);
      d.translation_off = std::max(d.translation_off, off.translation.norm());
      d.rotation_off = std::max(d.rotation_off, angle(off));
    }
    return all;
  }

  Trajectory corrected() const {
    Trajectory result = odometry_;
    for (const Pair& pair : pairs_)
      for (std::uint32_t k = pair.a + 1; k <= pair.b; ++k) {
        const Pose motion =
            !pair.followed.empty() ? pair.followed[k - pair.a - 1]
            : pair.better
                ? scaled(*pair.better, static_cast<double>(k - pair.a) / (pair.b - pair.a))
                : odometry_.T_world_frame[pair.a].inverse() * odometry_.T_world_frame[k];
        result.T_world_frame[k] = result.T_world_frame[pair.a] * motion;
      }
    return result;
  }

  const Trajectory& odometry_;
  const std::function<std::shared_ptr<const Frame>(std::size_t)>& open_;
  const DivergenceOptions& options_;
  std::vector<Pair> pairs_;
  double usual_time_ = 0;  ///< [s] between two frames, the median
};

}  // namespace

CheckedOdometry check_odometry(const Trajectory& odometry,
                               const std::function<std::shared_ptr<const Frame>(std::size_t)>& open,
                               const DivergenceOptions& options, Context& context) {
  return Checker(odometry, open, options).run(context);
}

std::string kind_of(const Divergence& d) {
  char text[64];
  const double ratio = d.registered_path > 0.1 ? d.odometry_path / d.registered_path : 1;
  const bool turned = d.rotation_off > 0.26 && d.rotation_off * 10 > d.translation_off;
  if (ratio < 0.1 && d.registered_path > 1)
    std::snprintf(text, sizeof text, "stands still");
  else if (turned)
    std::snprintf(text, sizeof text, "turns by %.0f deg", d.rotation_off * 180 / std::numbers::pi);
  else if (d.translation_off > 10)
    std::snprintf(text, sizeof text, "jumps by %.1f m", d.translation_off);
  else if (ratio > 0.8 && ratio < 1.25)
    std::snprintf(text, sizeof text, "is off by %.1f m and %.0f deg", d.translation_off,
                  d.rotation_off * 180 / std::numbers::pi);
  else
    std::snprintf(text, sizeof text, "has %.1f times the path", ratio);
  return text;
}

}  // namespace plumb::check_odometry
