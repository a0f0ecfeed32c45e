#include "plumb/engine/remote/slurm/profile.hpp"

#include "../fuzz.hpp"

using namespace plumb;

PLUMB_FUZZ_READER(profile) {
  const ExecutorProfile profile = read_profile(fuzz::file_of(bytes));
  fuzz::require(profile.cpus >= 1 && profile.chunk >= 1 && profile.tries >= 1 && profile.poll > 0,
                "a profile's numbers are in range");
}
