#include "../fuzz.hpp"
#include "plumb/data/archive.hpp"
#include "plumb/slam/io/cloud_file.hpp"

using namespace plumb;

PLUMB_FUZZ_READER(ply) {
  const Cloud cloud = read_ply(fuzz::file_of(bytes, "a.ply")).cloud;
  const Cloud again = read_ply(fuzz::file_of(ply_bytes(cloud), "b.ply")).cloud;
  fuzz::require(to_bytes(cloud) == to_bytes(again),
                "a cloud that was read is the same after it was written as PLY");
}
