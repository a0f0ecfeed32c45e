#include "plumb/store/index.hpp"

#include "../fuzz.hpp"

using namespace plumb;

/// The database of an index whose last user did not close it: every row is looked at, and a damaged
/// one is made anew.
PLUMB_FUZZ_READER(index) {
  for (const char* part : {"index.sqlite-wal", "index.sqlite-shm", "index.sum"})
    std::filesystem::remove(fuzz::folder() / part);
  fuzz::file_of(bytes, "index.sqlite");
  Index index(fuzz::folder());
  index.facts("pipeline.yaml", "segments", 0);
  index.file_hash("/data/0.pcd", 1, 2);
  index.recalled({1, 2});
  index.settle_recalled(0);
  index.made({1, 2}, "describe.fpfh", 3);
  fuzz::require(index.fault().empty() && index.rows().size() == 1,
                "a damaged index is made anew and can be used");
  if (!index.rebuilt().empty()) throw Error(index.rebuilt());
}
