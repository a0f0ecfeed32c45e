#include "../finite.hpp"
#include "../fuzz.hpp"
#include "calibration.hpp"

using namespace plumb;

PLUMB_FUZZ_READER(kitti_calibration) {
  fuzz::require(is_finite(source_kitti::read_calibration(fuzz::file_of(bytes))),
                "a calibration that was read is finite");
}
