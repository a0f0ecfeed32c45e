#include "plumb/slam/step.hpp"

#include <algorithm>
#include <cmath>

#include "map_file.hpp"
#include "plumb/data/document.hpp"
#include "plumb/plugin/module.hpp"
#include "voxel_map.hpp"

namespace plumb::write_map {
namespace {

struct WriteMap : WholeStep {
  struct In {
    Each<Frame> frames;
    One<Trajectory> trajectory;
    One<Metrics> scale;
  };
  struct Out {
    Document document;
  };
  struct Params {
    std::string name = "map.ply";
    double voxel_size = 0.1;
    MapFormat format = MapFormat::ply;
    std::string check() const {
      return name.empty() || name.find('/') != std::string::npos
                 ? "name must be a file name without a folder, not '" + name + "'"
                 : "";
    }
  };

  static void describe(Declaration<WriteMap>& is) {
    is.name("write.map")
        .version(2)
        .summary("Writes the map: the points of all frames under their poses, one per voxel.");
    is.input("frames", &In::frames, "the frames, read one after another");
    is.input("trajectory", &In::trajectory, "their poses");
    is.scale(&In::scale);
    is.output("document", &Out::document, "the file");
    is.param("name", &Params::name).doc("name of the file in the output folder");
    is.param("voxel_size", &Params::voxel_size)
        .unit("m")
        .range(0.005, 100)
        .doc("edge length of a voxel, of which the mean of its points is written");
    is.choice("format", &Params::format,
              {{"ply", MapFormat::ply, "binary PLY"}, {"pcd", MapFormat::pcd, "binary PCD"}})
        .doc("file format");
  }

  /// Frames that are decoded in parallel before they are added: bounds the memory, and is enough
  /// for 16 threads.
  static constexpr std::size_t block = 16;

  Out run(const In& in, const Params& params, Context& context) const {
    const std::size_t frames = in.frames.size();
    require_pose_each(*in.trajectory, frames);
    const Eigen::Vector3d origin = map_origin(*in.trajectory);
    VoxelMap map(params.voxel_size, origin);
    std::uint64_t points = 0, too_far = 0;
    std::vector<VoxelMap::FrameCells> cells(block);
    std::vector<std::uint64_t> counts(block);
    for (std::size_t first = 0; first < frames; first += block) {
      const std::size_t n = std::min(block, frames - first);
      context.parallel(n, [&](std::size_t k) {
        const auto frame = in.frames.open(first + k);
        cells[k] = map.cells_of(frame->cloud, in.trajectory->T_world_frame[first + k]);
        counts[k] = frame->cloud.size();
      });
      map.add({cells.data(), n}, parallel::on(context));
      for (std::size_t k = 0; k < n; ++k) points += counts[k], too_far += cells[k].too_far;
    }
    cells = std::vector<VoxelMap::FrameCells>();
    context.count("points read for the map", points);
    context.count("points in the map", map.size());
    if (map.size() == 0)
      throw Error("no point is left for the map of " + std::to_string(frames) +
                  " frames: look at the ranges, leaves and filters before it (`counted:` says "
                  "where points were dropped)");
    if (too_far) context.count("points too far from the map's origin dropped", too_far);
    FileBytes bytes = map_header(map.size(), origin, params.format);
    map.write(bytes);
    return {{params.name, std::move(bytes)}};
  }
};

}  // namespace
}  // namespace plumb::write_map

PLUMB_MODULE(plumb::write_map::WriteMap)
