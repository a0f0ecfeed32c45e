#include "../finite.hpp"
#include "../fuzz.hpp"
#include "g2o_file.hpp"
#include "plumb/slam/fault.hpp"

using namespace plumb;

PLUMB_FUZZ_READER(g2o) {
  const source_g2o::G2oGraph graph = source_g2o::read_g2o(fuzz::file_of(bytes));
  fuzz::require(is_finite(graph.poses.T_world_segment), "vertices that were read are finite");
  fuzz::require(*fault_in(graph.constraints) == '\0', "edges that were read are finite");
  for (const RelativePose& edge : graph.constraints.relative)
    fuzz::require(edge.i < graph.poses.size() && edge.j < graph.poses.size(),
                  "edges that were read join vertices");
}
