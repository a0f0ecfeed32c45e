#include "plumb/slam/step.hpp"

#include <algorithm>

#include "occupancy.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::map_occupancy_grid {
namespace {

struct OccupancyGrid : WholeStep {
  struct In {
    Each<Frame> frames;
    One<Trajectory> trajectory;
  };
  struct Out {
    GridMap map;
  };
  using Params = GridOptions;

  static void describe(Declaration<OccupancyGrid>& is) {
    is.name("map.occupancy_grid").version(1).source("[Moravec1985], [Hornung2013]");
    is.summary("Builds an occupancy grid from 2-D scans by ray casting.");
    is.input("frames", &In::frames, "the scans");
    is.input("trajectory", &In::trajectory, "the sensor's pose for each scan");
    is.output("map", &Out::map, "log odds of each cell; 0: unknown");
    is.param("resolution", &Params::resolution)
        .unit("m")
        .range(0.001, 10)
        .doc("edge length of a cell");
    is.param("hit", &Params::hit)
        .range(1e-3, 10)
        .doc("log odds that a scan adds to a cell in which a ray ends");
    is.param("miss", &Params::miss)
        .range(1e-3, 10)
        .doc("log odds that a scan subtracts from a cell that rays only cross");
    is.param("min_log_odds", &Params::min_log_odds)
        .range(-100, 0)
        .doc("lower bound of a cell's log odds");
    is.param("max_log_odds", &Params::max_log_odds)
        .range(0, 100)
        .doc("upper bound of a cell's log odds");
    is.param("max_range", &Params::max_range)
        .unit("m")
        .range(0.1, 1000)
        .doc("rays that end farther away are no hits; they clear the cells up to this distance");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    const std::size_t frames = in.frames.size();
    require_pose_each(*in.trajectory, frames);
    std::vector<PlacedScan> scans(frames);
    context.parallel(frames, [&](std::size_t k) {
      scans[k] = placed(in.frames.open(k)->cloud, in.trajectory->T_world_frame[k]);
    });
    Out out{occupancy(scans, params, parallel::on(context))};
    const auto seen = [&](auto test) {
      return static_cast<std::uint64_t>(std::ranges::count_if(out.map.log_odds, test));
    };
    context.count("cells occupied", seen([](float v) { return v > 0; }));
    context.count("cells free", seen([](float v) { return v < 0; }));
    return out;
  }
};

}  // namespace
}  // namespace plumb::map_occupancy_grid

PLUMB_MODULE(plumb::map_occupancy_grid::OccupancyGrid)
