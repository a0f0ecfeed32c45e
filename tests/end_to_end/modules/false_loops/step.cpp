/// Loops that are made wrong on purpose, so that it is known which ones are: each in a way of its
/// own, or several of one place alike. tools/false_loops.py puts them into the shipped pipelines.
#include "plumb/slam/step.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "plumb/data/random.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/slam/registration.hpp"
#include "plumb/slam/trajectory_error.hpp"
#include "plumb/slam/values.hpp"

namespace plumb {
namespace {

struct FalseLoops {
  double share = 0.3;
  std::uint32_t together = 1;
  double min_offset = 2, max_offset = 20, max_rotation = 20 * deg;
  std::uint32_t seed = 1;

  template <class Declare>
  static void describe(Declare& is) {
    is.param("share", &FalseLoops::share).unit("%").range(0, 1).doc("share of the loops to spoil");
    is.param("together", &FalseLoops::together)
        .range(1, 1000)
        .doc("so many loops near each other are spoilt alike, so that they agree");
    is.param("min_offset", &FalseLoops::min_offset)
        .unit("m")
        .range(0, 1e4)
        .doc("moved by at least");
    is.param("max_offset", &FalseLoops::max_offset).unit("m").range(0, 1e4).doc("moved by at most");
    is.param("max_rotation", &FalseLoops::max_rotation)
        .unit("rad")
        .range(0, 180 * deg)
        .doc("turned about the vertical by at most");
    is.param("seed", &FalseLoops::seed).doc("another choice for each number");
  }
};

/// Edge k says motion * T_i_j where it should say T_i_j.
struct Spoilt {
  std::size_t k = 0;
  Pose motion;
};

std::uint32_t apart(std::uint32_t a, std::uint32_t b) { return a > b ? a - b : b - a; }

/// Of the world, along the ground and about the vertical through `centre`.
Pose drawn_motion(const FalseLoops& options, const Eigen::Vector3d& centre, Random& random) {
  const double heading = 360 * deg * random.uniform();
  const double offset =
      options.min_offset + (options.max_offset - options.min_offset) * random.uniform();
  const double rotation = options.max_rotation * (2 * random.uniform() - 1);
  const Pose to_centre(Eigen::Quaterniond::Identity(), centre);
  const Pose motion(exp_rotation(Eigen::Vector3d(0, 0, rotation)),
                    Eigen::Vector3d(offset * std::cos(heading), offset * std::sin(heading), 0));
  return to_centre * motion * to_centre.inverse();
}

/// Of `loops`, places in `edges`. At least one group where any is wanted, and then as many whole
/// groups as the share has room for.
std::vector<Spoilt> spoilt(const std::vector<Edge>& edges, std::vector<std::size_t> loops,
                           const Poses& poses, const FalseLoops& options) {
  Random random(options.seed);
  const auto wanted =
      static_cast<std::size_t>(std::lround(options.share * static_cast<double>(loops.size())));
  std::vector<Spoilt> all;
  while (all.size() < wanted && (all.empty() || all.size() + options.together <= wanted)) {
    const Edge first = edges[loops[random.below(static_cast<std::uint32_t>(loops.size()))]];
    std::ranges::stable_sort(loops, {}, [&](std::size_t k) {
      return apart(edges[k].i, first.i) + apart(edges[k].j, first.j);
    });
    const Pose motion = drawn_motion(options, poses.T_world_segment[first.i].translation, random);
    const std::size_t count = std::min<std::size_t>(options.together, loops.size());
    for (std::size_t n = 0; n < count; ++n) {
      const Pose& T_world_i = poses.T_world_segment[edges[loops[n]].i];
      all.push_back({loops[n], T_world_i.inverse() * motion * T_world_i});
    }
    loops.erase(loops.begin(), loops.begin() + static_cast<std::ptrdiff_t>(count));
  }
  return all;
}

/// A record for each of `loops`, places in `edges`.
Metrics metrics_of(const std::vector<Edge>& edges, const std::vector<std::size_t>& loops,
                   const std::vector<Spoilt>& all) {
  Metrics metrics;
  metrics.add("spoilt", static_cast<double>(all.size()), "")
      .add("loops", static_cast<double>(loops.size()), "");
  for (const std::size_t k : loops) {
    const auto wrong = std::ranges::find(all, k, &Spoilt::k);
    EdgeRecord record;
    record.i = edges[k].i, record.j = edges[k].j;
    record.kind = edges[k].kind;
    record.residual = wrong == all.end() ? 0 : wrong->motion.translation.norm();
    record.status = wrong == all.end() ? "as it was" : "spoilt";
    metrics.edges.push_back(std::move(record));
  }
  return metrics;
}

/// Of those that were registered.
struct FalseRegistrations : WholeStep {
  struct In {
    Each<Registration> registrations;
    One<Poses> poses;
    One<Metrics> scale;
  };
  struct Out {
    std::vector<Registration> registrations;
    Metrics metrics;
  };
  using Params = FalseLoops;

  static void describe(Declaration<FalseRegistrations>& is) {
    is.name("test.false_loops").version(1).summary("Makes some registered loops wrong.");
    is.input("registrations", &In::registrations, "registrations of loop edges");
    is.input("poses", &In::poses, "poses of the segments");
    is.scale(&In::scale);
    is.output("registrations", &Out::registrations, "the same, some of them wrong")
        .over("registrations");
    is.output("metrics", &Out::metrics, "which are wrong");
    FalseLoops::describe(is);
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Edges& edges = edges_of(in.registrations);
    require_pose_each(*in.poses, edges.segments);
    Out out;
    out.registrations = in.registrations.all(context);
    std::vector<std::size_t> loops;
    for (std::size_t k = 0; k < out.registrations.size(); ++k)
      if (out.registrations[k].accepted) loops.push_back(k);
    const auto all = spoilt(edges.list, loops, *in.poses, params);
    for (const Spoilt& one : all) {
      Pose& T_i_j = out.registrations[one.k].T_i_j;
      T_i_j = one.motion * T_i_j;
    }
    out.metrics = metrics_of(edges.list, loops, all);
    return out;
  }
};

/// Of those with matches, and with so much path between their ends that they are another visit:
/// a neighbour by overlap may be one, too.
struct FalseMatches : WholeStep {
  struct In {
    Each<Matches> matches;
    One<Poses> poses;
    One<Metrics> scale;
  };
  struct Out {
    std::vector<Matches> matches;
    Metrics metrics;
  };
  struct Params : FalseLoops {
    double min_path_separation = 40;
  };

  static void describe(Declaration<FalseMatches>& is) {
    is.name("test.false_matches").version(1).summary("Makes the matches of some loops wrong.");
    is.input("matches", &In::matches, "matches of edges, loops among them");
    is.input("poses", &In::poses, "poses of the segments");
    is.scale(&In::scale);
    is.output("matches", &Out::matches, "the same, those of some loops wrong").over("matches");
    is.output("metrics", &Out::metrics, "which are wrong");
    FalseLoops::describe(is);
    is.param("min_path_separation", &Params::min_path_separation)
        .unit("m")
        .range(0, 1e6)
        .doc("edges with less path between their ends are no loops");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const Edges& edges = edges_of(in.matches);
    require_pose_each(*in.poses, edges.segments);
    Out out;
    out.matches = in.matches.all(context);
    const std::vector<double> path = path_of(in.poses->T_world_segment);
    std::vector<std::size_t> loops;
    for (std::size_t k = 0; k < out.matches.size(); ++k)
      if (out.matches[k].size() > 0 &&
          path[edges.list[k].j] - path[edges.list[k].i] >= params.min_path_separation)
        loops.push_back(k);
    const auto all = spoilt(edges.list, loops, *in.poses, params);
    for (const Spoilt& one : all) {
      const Motion motion(one.motion);
      for (auto& p : out.matches[one.k].p) p = motion * p;
      for (auto& normal : out.matches[one.k].normal_p) normal = motion.r * normal;
    }
    out.metrics = metrics_of(edges.list, loops, all);
    return out;
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::FalseRegistrations, plumb::FalseMatches)
