#include "../finite.hpp"
#include "../fuzz.hpp"
#include "plumb/slam/io/trajectory_file.hpp"

using namespace plumb;

PLUMB_FUZZ_READER(mulran_csv) {
  const Trajectory read = read_mulran_csv(fuzz::file_of(bytes));
  fuzz::require(is_finite(read.T_world_frame), "poses that were read are finite");
}
