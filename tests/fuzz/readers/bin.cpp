#include "../fuzz.hpp"
#include "plumb/slam/io/bin_file.hpp"

using namespace plumb;

PLUMB_FUZZ_READER(bin) {
  const CloudFile read = read_bin(fuzz::file_of(bytes, "a.bin"));
  fuzz::require(read.cloud.size() + read.dropped == bytes.size() / 16,
                "every point is taken or counted as dropped");
}
