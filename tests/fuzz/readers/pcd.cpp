#include "../fuzz.hpp"
#include "plumb/data/archive.hpp"
#include "plumb/slam/io/cloud_file.hpp"

using namespace plumb;

PLUMB_FUZZ_READER(pcd) {
  const Cloud cloud = read_pcd(fuzz::file_of(bytes, "a.pcd")).cloud;
  const Cloud again = read_pcd(fuzz::file_of(pcd_bytes(cloud), "b.pcd")).cloud;
  fuzz::require(to_bytes(cloud) == to_bytes(again),
                "a cloud that was read is the same after it was written as PCD");
}
