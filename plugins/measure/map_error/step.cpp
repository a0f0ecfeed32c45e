#include "plumb/slam/step.hpp"

#include <cmath>

#include "map_error.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/slam/io/trajectory_file.hpp"

namespace plumb::measure_map_error {
namespace {

struct MeasureMapError : WholeStep {
  struct In {
    One<GridMap> map;
    One<Trajectory> trajectory;
  };
  struct Out {
    Metrics metrics;
  };
  struct Params {
    std::optional<std::filesystem::path> plan, truth;
    double tolerance = 2e-3;
    double occupied = 0.65;
    double max_wall_distance = 0.1;
  };

  static void describe(Declaration<MeasureMapError>& is) {
    is.name("measure.map_error")
        .version(1)
        .source("[Zhang2023] 3; the alignment and what counts as accurate are ours");
    is.summary("Measures the distance of a map's walls from those of the true floor plan.");
    is.input("map", &In::map, "the map");
    is.optional_input(
        "trajectory", &In::trajectory,
        "the poses from which the map was made; with 'truth' they align it with the plan");
    is.output("metrics", &Out::metrics,
              "mean, rms, largest, percentile_99, accuracy, coverage, occupied");
    is.param("plan", &Params::plan)
        .doc("true walls, lines 'x1 y1 x2 y2' [m]; none: a note, and no numbers");
    is.param("truth", &Params::truth)
        .doc(
            "TUM file with the true poses in the plan's coordinates; none: the map is in these "
            "coordinates already");
    is.param("tolerance", &Params::tolerance)
        .unit("s")
        .range(1e-9, 10)
        .doc("poses whose stamps differ by less are associated");
    is.param("occupied", &Params::occupied)
        .range(0.5, 0.999)
        .doc("probability above which a cell is a wall");
    is.param("max_wall_distance", &Params::max_wall_distance)
        .unit("m")
        .range(0.001, 10)
        .doc("a cell at most this far from a wall is correct, for accuracy and coverage");
  }

  Out run(const In& in, const Params& params, Context& context) const {
    Out out;
    if (!params.plan) {
      out.metrics.notes.push_back("no plan was given, so the map's error is not known");
      return out;
    }
    const auto walls = read_plan(*params.plan);
    PlanarPose T_plan_map;
    if (params.truth) {
      if (!in.trajectory)
        throw Error(
            "measure.map_error has a truth but no trajectory to align with it: wire 'trajectory' "
            "or "
            "set 'truth: none'");
      const PosePairs pairs =
          pair_by_stamp(*in.trajectory, read_tum(*params.truth, StampOrder::any), params.tolerance);
      if (pairs.size() == 0)
        throw Error(params.truth->string() +
                    ": no pose has the stamp of a pose of the trajectory, so the map cannot be "
                    "aligned with the plan; "
                    "look whether both count the same seconds");
      T_plan_map = planar_alignment(pairs);
    }
    const auto threshold = static_cast<float>(std::log(params.occupied / (1 - params.occupied)));
    const MapError error = map_error(*in.map, walls, T_plan_map, threshold,
                                     params.max_wall_distance, parallel::on(context));
    if (error.occupied == 0) {
      out.metrics.notes.push_back("the map has no occupied cell, so it has no error");
      return out;
    }
    out.metrics.add("mean", error.mean, "m")
        .add("rms", error.rms, "m")
        .add("largest", error.largest, "m")
        .add("percentile_99", error.percentile_99, "m")
        .add("accuracy", error.accuracy, "")
        .add("coverage", error.coverage, "")
        .add("occupied", static_cast<double>(error.occupied), "cells");
    return out;
  }
};

}  // namespace
}  // namespace plumb::measure_map_error

PLUMB_MODULE(plumb::measure_map_error::MeasureMapError)
