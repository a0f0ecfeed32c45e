#include "plumb/slam/step.hpp"

#include "map_image.hpp"
#include "plumb/data/document.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb::write_map2d {
namespace {

struct WriteMap2d : WholeStep {
  struct In {
    One<GridMap> map;
  };
  struct Out {
    Document pgm, yaml, png;
  };
  struct Params {
    std::string name = "map";
    double occupied = 0.65;
    double free = 0.196;
    std::string check() const {
      if (name.empty() || name.find_first_of("/'\"#:{}[],&*!|>%@` \n") != std::string::npos)
        return "name must be a plain word without a folder, not '" + name +
               "': .pgm, .yaml and .png are added to it";
      return free < occupied ? "" : "free must be below occupied";
    }
  };

  static void describe(Declaration<WriteMap2d>& is) {
    is.name("write.map2d").version(1).source("ROS map_server's format");
    is.summary("Writes a grid map as ROS map_server reads it (PGM and YAML), and as PNG.");
    is.input("map", &In::map, "the map");
    is.output("pgm", &Out::pgm, "NAME.pgm: black occupied, white free, grey unknown");
    is.output("yaml", &Out::yaml, "NAME.yaml: the image's origin and resolution");
    is.output("png", &Out::png, "NAME.png: for viewing, shaded by probability");
    is.param("name", &Params::name)
        .doc("name of the files in the output folder, without an ending");
    is.param("occupied", &Params::occupied)
        .range(0.5, 0.999)
        .doc("probability above which a cell is occupied in the PGM");
    // Grey 205 stands for unknown and is read as 50 / 255 = 0.19608: it must not be below the
    // threshold.
    is.param("free", &Params::free)
        .range(0.001, 0.196)
        .doc("probability below which a cell is free in the PGM");
  }

  Out run(const In& in, const Params& params, Context&) const {
    const GridMap& map = *in.map;
    if (map.log_odds.empty())
      throw Error(
          "the map has no cells, so there is no image of it; look whether there were frames");
    const Thresholds thresholds{params.occupied, params.free};
    const std::string image = params.name + ".pgm";
    return {{image, pgm_bytes(decided(map, thresholds))},
            {params.name + ".yaml", map_yaml(map, image, thresholds)},
            {params.name + ".png", png_bytes(shaded(map))}};
  }
};

}  // namespace
}  // namespace plumb::write_map2d

PLUMB_MODULE(plumb::write_map2d::WriteMap2d)
