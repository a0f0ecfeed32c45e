#include "plumb/slam/step.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "carmen_log.hpp"
#include "decompress.hpp"
#include "plumb/data/io/file_text.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/slam/io/frame_selection.hpp"
#include "scan_cloud.hpp"

namespace plumb::source_carmen {
namespace {

enum class OdometryUse { use, ignore };

struct Carmen : WholeStep {
  struct In {};
  struct Out {
    Lazy<Frame> frames;
    Trajectory trajectory;
  };
  struct Params {
    std::filesystem::path path;
    OdometryUse odometry = OdometryUse::use;
    double min_range = 0.05;
    std::optional<double> max_range;
    std::optional<double> field_of_view;
    io::FrameSelection selection;
  };

  static void describe(Declaration<Carmen>& is) {
    is.name("source.carmen").version(1).source("CARMEN's log format");
    is.summary(
        "Reads the scans of a 2-D laser and their odometry from a CARMEN log, which may be "
        "compressed.");
    is.output("frames", &Out::frames,
              "one scan per frame: points in the laser's coordinates, z = 0");
    is.output("trajectory", &Out::trajectory,
              "stamp and pose of the laser for every scan, in the order of the file");
    is.param("path", &Params::path)
        .required()
        .doc(
            "log with FLASER, ROBOTLASER1 or RAWLASER1 lines (.clf, .log); gzip and bzip2 are "
            "decompressed");
    is.choice("odometry", &Params::odometry,
              {{"use", OdometryUse::use, "poses from wheel odometry"},
               {"ignore", OdometryUse::ignore, "every pose is the identity; stamps are kept"}})
        .doc("what the poses of the trajectory are");
    is.param("min_range", &Params::min_range)
        .unit("m")
        .range(0, 100)
        .doc("nearer readings are dropped: no return, or the robot itself");
    is.param("max_range", &Params::max_range)
        .unit("m")
        .range(0.01, 1000)
        .doc(
            "readings at or beyond this distance are no return and are dropped; none: found from "
            "the log");
    is.param("field_of_view", &Params::field_of_view)
        .unit("rad")
        .range(0.05 * deg, 360 * deg)
        .doc(
            "angle from the first beam to the last, centred ahead; none: as the log says, or "
            "CARMEN's convention");
    is.params(&Params::selection);
  }

  Out run(const In&, const Params& params, Context& context) const {
    if (std::filesystem::is_directory(params.path)) {
      const auto inside = params.path / "log.clf";
      io::refuse(params.path, "is a folder: give the log in it" +
                                  (std::filesystem::exists(inside) ? ", " + inside.string()
                                                                   : std::string(", a .clf file")));
    }
    const std::string text = unpacked(params.path);
    const auto log = std::make_shared<const CarmenLog>(
        used_of(parse_carmen(params.path, text, parallel::on(context)), params, context));
    const auto& scans = log->scans;
    if (scans.size() < 2)
      io::refuse(params.path,
                 "has 1 whole scan, but at least 2 are needed: there is nothing to straighten");
    report(params, *log, context);

    const double repeated = repeated_maximum(scans).value_or(80);
    const auto fan = [params](const LaserScan& scan) { return fan_of(scan, params.field_of_view); };
    const auto limits = [params, repeated](const LaserScan& scan) {
      if (params.max_range) return Limits{params.min_range, *params.max_range};
      const double own = scan.maximum > 0 ? 0.99 * scan.maximum : repeated;
      return Limits{params.min_range, std::min(own, repeated)};
    };

    Out out;
    out.frames.keys.resize(scans.size());
    std::vector<LeftOut> left(scans.size());
    context.parallel(scans.size(), [&](std::size_t k) {
      out.frames.keys[k] =
          content_hash(cloud_of(scans[k], fan(scans[k]), limits(scans[k]), &left[k]));
    });
    LeftOut sum;
    for (const LeftOut& l : left)
      sum.nothing_seen += l.nothing_seen, sum.too_near += l.too_near, sum.no_number += l.no_number;
    count(context, "beams that saw nothing dropped", sum.nothing_seen);
    count(context, "beams nearer than min_range dropped", sum.too_near);
    count(context, "beams with a non-finite range dropped", sum.no_number);

    out.trajectory = trajectory_of(*log, params.odometry == OdometryUse::use);
    out.frames.open = [log, fan, limits](std::size_t k, Context&) {
      const LaserScan& scan = log->scans[k];
      return Frame{static_cast<std::uint32_t>(k), cloud_of(scan, fan(scan), limits(scan))};
    };
    return out;
  }

  /// With the scans that are used alone.
  static CarmenLog used_of(CarmenLog log, const Params& params, Context& context) {
    if (params.selection.all()) return log;
    const auto used = params.selection.indices(log.scans.size(), params.path.string());
    count(context, "scans left out as told", log.scans.size() - used.size());
    log.scans = io::selected(std::move(log.scans), used);
    return log;
  }

  static Trajectory trajectory_of(const CarmenLog& log, bool use_odometry) {
    const Pose T_robot_laser = mounting_of(log.scans, log.front_laser_offset);
    Trajectory trajectory;
    for (const LaserScan& scan : log.scans) {
      trajectory.stamps.push_back(scan.stamp);
      trajectory.T_world_frame.push_back(
          use_odometry && scan.robot ? in_space(*scan.robot) * T_robot_laser : Pose());
    }
    return trajectory;
  }

  static void count(Context& context, std::string_view what, std::size_t n) {
    if (n) context.count(what, n);
  }

  /// Says what is in the log, and warns of what is weak.
  static void report(const Params& params, const CarmenLog& log, Context& context) {
    const auto& scans = log.scans;
    context.count("scans read", scans.size());
    count(context, "odometry lines beside the scans", log.odometry_lines);
    count(context, "scans of a second laser left out", log.second_laser);
    count(context, "lines without a CARMEN message left out", log.no_message);
    count(context, "other messages of the same laser left out", log.repeated);
    std::size_t back = 0, unknown = 0;
    bool moves = false;
    for (std::size_t k = 0; k < scans.size(); ++k) {
      back += k > 0 && scans[k].stamp < scans[k - 1].stamp;
      unknown += !fan_of(scans[k], params.field_of_view).known;
      const auto &a = scans[k].robot, &b = scans[0].robot;
      moves = moves || (a && b && (a->x != b->x || a->y != b->y || a->yaw != b->yaw));
    }
    count(context, "stamps out of order kept in the file's order", back);
    const std::string file = params.path.string();
    if (log.cut + log.not_numbers)
      context.warn(file + ":" + std::to_string(log.first_damaged) +
                   ": the first scan of those left out for a wrong number of words (" +
                   std::to_string(log.cut) + ") or for words that are not numbers (" +
                   std::to_string(log.not_numbers) + ")");
    count(context, "damaged scans left out", log.cut + log.not_numbers);
    if (unknown)
      context.warn(file + ": scans whose number of beams (" +
                   std::to_string(scans[0].ranges.size()) +
                   " or another) is of no known scanner are taken as 180 degrees (" +
                   std::to_string(unknown) + "): set field_of_view if that is wrong");
    if (params.odometry == OdometryUse::use && !moves)
      context.warn(file +
                   ": has no odometry, or the robot never moves by it; every pose is the same: set "
                   "'odometry: ignore' if that is right");
  }
};

}  // namespace
}  // namespace plumb::source_carmen

PLUMB_MODULE(plumb::source_carmen::Carmen)
