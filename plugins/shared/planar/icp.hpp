#pragma once
/// Iterated closest points in the plane, with two rules for when to stop. Source: [Zhang2023] eq.
/// (1) to (12); the distance to lines, the prior and the rule `change` are ours.

#include <cstdint>
#include <optional>
#include <span>

#include "plumb/slam/geometry/search_tree.hpp"
#include "shared/planar/planar_pose.hpp"

namespace plumb::planar {

enum class Stop {
  change,  ///< the pose moved by less than `change` ([m] + [rad]): the usual ICP
  ratio    ///< MAE_n / MAE_(n-1) >= ratio: IA-ICP, eq. (12); MAE is the mean distance of the pairs
};
enum class Metric {
  point,  ///< eq. (3): the distance of the pairs
  line    ///< its part along the target's normal; pairs whose target point has none are left out
};

/// Points of the plane [m] that lie elsewhere, and their unit normals; nx and ny are empty where
/// there are none, (0, 0) where a point has none.
struct PlanarPoints {
  std::span<const float> x, y, nx, ny;

  /// Of anything with arrays x, y, nx, ny, such as a Cloud.
  template <class Points>
  PlanarPoints(const Points& points) : x(points.x), y(points.y), nx(points.nx), ny(points.ny) {}
  std::size_t size() const { return x.size(); }
  bool has_normals() const { return !x.empty() && nx.size() == x.size(); }
};

struct IcpOptions {
  Stop stop = Stop::change;
  Metric metric = Metric::point;
  double change = 1e-4;
  double ratio = 0.95;
  double max_correspondence_distance = 0.3;  ///< [m] between the points of a pair
  std::uint32_t max_iterations = 50;         ///< at most
  double noise = 0.03;                       ///< [m] standard deviation of a pair's residual
  /// [m] standard deviation of the start's place; its heading's is a third of that in rad.
  /// Metric::line only
  std::optional<double> start_sigma = {};

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.choice("stop", &IcpOptions::stop,
              {{"ratio", Stop::ratio,
                "when the mean distance of the pairs stops decreasing: IA-ICP, eq. (12)"},
               {"change", Stop::change, "when the pose converges: standard ICP"}})
        .doc("when a registration ends")
        .source("[Zhang2023] 2, eq. (12) for ratio");
    is.choice(
          "metric", &IcpOptions::metric,
          {{"point", Metric::point, "point-to-point distance"},
           {"line", Metric::line,
            "point-to-line distance, along the target's normal (estimate.normals with planar)"}})
        .doc("the error that is minimised")
        .source("[Zhang2023] eq. (3) for point");
    is.param("max_correspondence_distance", &IcpOptions::max_correspondence_distance)
        .unit("m")
        .range(1e-3, 100)
        .doc("distance between the two points of a pair");
    is.param("max_iterations", &IcpOptions::max_iterations)
        .range(0, 10000)
        .doc("iterations; 0: the initial guess is only evaluated");
    is.param("change", &IcpOptions::change)
        .range(1e-9, 1)
        .doc("converged when an iteration moves the pose by less, m and rad added");
    is.param("ratio", &IcpOptions::ratio)
        .range(0, 1)
        .source("[Zhang2023] 2")
        .doc(
            "stops when the mean distance of the pairs is at least this times that of the "
            "iteration before");
    is.param("noise", &IcpOptions::noise)
        .unit("m")
        .range(1e-4, 10)
        .doc("standard deviation of a pair's residual, for the information");
    is.param("start_sigma", &IcpOptions::start_sigma)
        .unit("m")
        .range(1e-4, 100)
        .doc(
            "with metric line, standard deviation of the initial guess's position, a third of it "
            "in rad for the heading; none: no prior");
  }
};

struct IcpResult {
  PlanarPose T;  ///< T_target_source
  std::uint32_t iterations = 0;
  std::uint32_t pairs = 0;  ///< in the last iteration
  double mae = 0;           ///< [m] mean distance of those pairs
  double overlap = 0;       ///< share of the source's points that have a pair
  Eigen::Matrix3d information =
      Eigen::Matrix3d::Zero();  ///< of x, y, yaw in the source's coordinates; see icp.cpp
};

/// Registers `source` to `target`, with the initial guess `start`. Pairs are each source point and
/// the nearest target point (`tree` holds the target's points, with z = 0). Fewer than 3 pairs: the
/// pose stays as it is and overlap says so. With 0 iterations the start is only evaluated.
IcpResult align(const PlanarPoints& target, const SearchTree& tree, const PlanarPoints& source,
                const PlanarPose& start, const IcpOptions& options);

}  // namespace plumb::planar
