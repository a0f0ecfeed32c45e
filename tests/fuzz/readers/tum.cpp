#include "../finite.hpp"
#include "../fuzz.hpp"
#include "plumb/slam/io/trajectory_file.hpp"

using namespace plumb;

PLUMB_FUZZ_READER(tum) {
  const Trajectory read = read_tum(fuzz::file_of(bytes), StampOrder::any);
  fuzz::require(is_finite(read.T_world_frame), "poses that were read are finite");
  const Trajectory again = read_tum(fuzz::file_of(tum_text(read)), StampOrder::any);
  fuzz::require(again.size() == read.size(),
                "a trajectory that was read can be read after it was written");
}
