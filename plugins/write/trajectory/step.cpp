#include "plumb/slam/step.hpp"

#include "plumb/data/document.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/slam/io/trajectory_file.hpp"

namespace plumb::write_trajectory {
namespace {

enum class Format { tum, kitti };

struct WriteTrajectory : WholeStep {
  struct In {
    One<Trajectory> trajectory;
  };
  struct Out {
    Document document;
  };
  struct Params {
    std::string name = "trajectory.tum";
    Format format = Format::tum;
    std::string check() const {
      return name.empty() || name.find('/') != std::string::npos
                 ? "name must be a file name without a folder, not '" + name + "'"
                 : "";
    }
  };

  static void describe(Declaration<WriteTrajectory>& is) {
    is.name("write.trajectory").version(1).summary("Writes the poses of all frames to a file.");
    is.input("trajectory", &In::trajectory, "the poses to write");
    is.output("document", &Out::document, "the file");
    is.param("name", &Params::name).doc("name of the file in the output folder");
    is.choice("format", &Params::format,
              {{"tum", Format::tum, "stamp tx ty tz qx qy qz qw, one line per frame"},
               {"kitti", Format::kitti,
                "the 12 numbers of a 3x4 matrix, one line per frame, no stamps"}})
        .doc("how the poses are written");
  }

  Out run(const In& in, const Params& params, Context&) const {
    return {{params.name,
             params.format == Format::tum ? tum_text(*in.trajectory) : kitti_text(*in.trajectory)}};
  }
};

}  // namespace
}  // namespace plumb::write_trajectory

PLUMB_MODULE(plumb::write_trajectory::WriteTrajectory)
